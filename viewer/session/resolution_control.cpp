#include "viewer/session/resolution_control.h"

#include <algorithm>

namespace whit::view {

constexpr double kNewest = 0.3;  // weight of the newest frame in the mean cost

void ResolutionControl::setRate(double framesPerSecond) {
  rate_ = std::clamp(framesPerSecond, kLeastRate, kLargestRate);
}

void ResolutionControl::learn(double ms, double samples) {
  if (!(ms > 0) || !(samples > 0)) return;
  const double cost = ms / samples;
  msPerSample_ = msPerSample_ > 0 ? std::lerp(msPerSample_, cost, kNewest) : cost;
}

void ResolutionControl::chooseLevel(double frameMs) {
  const std::size_t coarsest = kScales.size() - 1;
  if (level_ > 0 && predictMs(kScales[level_ - 1]) < kHeadroom * frameMs) {
    --level_;
  } else {
    while (level_ < coarsest && predictMs(kScales[level_]) > frameMs) ++level_;
  }
}

Sharpness ResolutionControl::moving(double windowPixels) {
  windowPixels_ = windowPixels;
  const double frameMs = 1000 / rate_;
  const std::size_t coarsest = kScales.size() - 1;
  if (msPerSample_ == 0) return {kScales[coarsest], 1};  // cheap in any scene
  chooseLevel(frameMs);

  // A link may carry fewer pixels than the machine can trace.
  const auto pixels = [&] { return windowPixels_ * kScales[level_] * kScales[level_]; };
  while (level_ < coarsest && pixels() > mostPixels_) ++level_;

  // Where even the coarsest scale is too slow, samples are saved as well.
  Sharpness chosen{kScales[level_], spp_};
  if (level_ < coarsest) return chosen;
  const double share = frameMs / predictMs(chosen.scale);
  if (share < 1) chosen.spp = std::max(static_cast<int>(spp_ * share), 1);
  return chosen;
}

std::vector<Sharpness> ResolutionControl::stepsAtRest(bool supersample) const {
  std::vector<Sharpness> steps;
  steps.reserve(std::size(kCoarseScales) + kStillSppFactors.size());

  for (const double scale : kCoarseScales) steps.push_back({scale, spp_});
  const std::size_t factors = sampled_ ? kStillSppFactors.size() : kUnsampledSppFactors;
  for (std::size_t i = 0; i < (supersample ? factors : 1); ++i) {
    steps.push_back({1, std::min(spp_ * kStillSppFactors[i], kSppLimit)});
    if (steps.back().spp == kSppLimit) break;
  }
  return steps;
}

Sharpness ResolutionControl::still(bool supersample) const {
  const std::vector<Sharpness> steps = stepsAtRest(supersample);
  return steps[std::min(step_, steps.size() - 1)];
}

bool ResolutionControl::sharpen(bool supersample) {
  if (step_ + 1 >= stepsAtRest(supersample).size()) return false;
  ++step_;
  return true;
}

void ResolutionControl::startSharpening(double windowPixels, double shownScale) {
  windowPixels_ = windowPixels;
  step_ = 0;

  // Steps are skipped if the next one takes little time, or if they are coarser than the picture
  // that is shown.
  const std::vector<Sharpness> steps = stepsAtRest(false);
  const auto soonThere = [&](double scale) {
    return msPerSample_ > 0 && predictMs(scale) <= kFirstStillMs;
  };

  while (step_ + 1 < steps.size() &&
         (soonThere(steps[step_ + 1].scale) || steps[step_].scale < shownScale)) {
    ++step_;
  }
}

}  // namespace whit::view
