#include "viewer/resolution_control.h"

#include <algorithm>

#include "core/options.h"

namespace whit::view {

namespace {

constexpr double kNewest = 0.3;  // weight of the newest frame in what is learned

}  // namespace

void ResolutionControl::setRate(double framesPerSecond) {
  rate_ = std::clamp(framesPerSecond, kLeastRate, kLargestRate);
}

void ResolutionControl::stepLargestScale(int steps) {
  const int last = static_cast<int>(kScales.size()) - 1;
  largest_ = static_cast<std::size_t>(std::clamp(static_cast<int>(largest_) - steps, 0, last));
  level_ = std::max(level_, largest_);
}

void ResolutionControl::learn(double ms, double samples) {
  if (!(ms > 0) || !(samples > 0)) return;
  const double cost = ms / samples;
  msPerSample_ = msPerSample_ > 0 ? msPerSample_ + kNewest * (cost - msPerSample_) : cost;
}

double ResolutionControl::predictMs(std::size_t level, double windowPixels) const {
  return msPerSample_ * windowPixels * kScales[level] * kScales[level] * spp_;
}

Sharpness ResolutionControl::moving(double windowPixels, double waitMs) {
  const double frameMs = 1000 / rate_ - waitMs;
  const std::size_t coarsest = kScales.size() - 1;
  if (level_ > largest_ && predictMs(level_ - 1, windowPixels) < kHeadroom * frameMs) {
    --level_;
  } else {
    while (level_ < coarsest && predictMs(level_, windowPixels) > frameMs) ++level_;
  }
  if (level_ < coarsest) return {kScales[level_], spp_};
  const double share = frameMs / predictMs(level_, windowPixels);
  return {kScales[level_], share < 1 ? std::max(static_cast<int>(spp_ * share), 1) : spp_};
}

Sharpness ResolutionControl::still() const {
  return {largestScale(), std::min(spp_ * kStillSppFactors[step_], kSppLimit)};
}

bool ResolutionControl::sharpen() {
  if (step_ + 1 >= kStillSppFactors.size() || still().spp == kSppLimit) return false;
  ++step_;
  return true;
}

}  // namespace whit::view
