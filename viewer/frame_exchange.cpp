#include "viewer/frame_exchange.h"

namespace whit::view {

bool FrameExchange::ask(const FrameRequest& request) {
  if (fresh_ || committed()) return false;
  asked_ = request;
  return true;
}

bool FrameExchange::take(TracedFrame& frame) {
  if (!fresh_) return false;
  std::swap(frame, ready_);
  fresh_ = false;
  return true;
}

std::optional<FrameRequest> FrameExchange::begin() {
  tracing_ = std::exchange(asked_, std::nullopt);
  return tracing_;
}

void FrameExchange::finish(TracedFrame& frame) {
  const bool dropped = !committed() && waiting();
  giveUp();
  if (!dropped) show(frame);
}

void FrameExchange::show(TracedFrame& frame) {
  std::swap(frame, ready_);
  fresh_ = true;
}

}  // namespace whit::view
