#include "viewer/session/history.h"

namespace whit::view {

namespace {

constexpr double kEditPauseSeconds = 0.5;  // a longer pause begins another edit
constexpr std::size_t kMostEdits = 200;    // limit on the edits that can be undone

}  // namespace

void History::add(const UserState& present) {
  const bool goesOn = states_.size() > 1 && sinceEdit_ < kEditPauseSeconds;
  if (goesOn) states_.pop_back();
  sinceEdit_ = 0;
  states_.push_back(present);
  if (states_.size() > kMostEdits) states_.erase(states_.begin());
}

void History::takeBack(const UserState& present) {
  states_.back() = present;
  if (states_.size() > 1 && states_.back() == states_[states_.size() - 2]) states_.pop_back();
}

std::optional<UserState> History::undo() {
  if (states_.size() < 2) return std::nullopt;
  states_.pop_back();
  sinceEdit_ = kEditPauseSeconds;  // what is edited next is another edit
  return states_.back();
}

void History::settleExposure(const Exposure& measured) {
  for (UserState& past : states_) {
    if (past.options.exposure.automatic) past.options.exposure = measured;
  }
}

}  // namespace whit::view
