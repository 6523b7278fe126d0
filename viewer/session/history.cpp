#include "viewer/session/history.h"

namespace whit::view {

namespace {

constexpr double kEditPauseSeconds = 0.5;  // a longer pause begins another edit
constexpr std::size_t kMostEdits = 200;    // that can be undone

}  // namespace

void History::add(const Past& present) {
  const bool goesOn = past_.size() > 1 && sinceEdit_ < kEditPauseSeconds;
  if (goesOn) past_.pop_back();
  sinceEdit_ = 0;
  past_.push_back(present);
  if (past_.size() > kMostEdits) past_.erase(past_.begin());
}

void History::takeBack(const Past& present) {
  past_.back() = present;
  if (past_.size() > 1 && past_.back() == past_[past_.size() - 2]) past_.pop_back();
}

std::optional<Past> History::undo() {
  if (past_.size() < 2) return std::nullopt;
  past_.pop_back();
  sinceEdit_ = kEditPauseSeconds;  // what is edited next is another edit
  return past_.back();
}

void History::settleExposure(const Exposure& measured) {
  for (Past& past : past_) {
    if (past.options.exposure.automatic) past.options.exposure = measured;
  }
}

}  // namespace whit::view
