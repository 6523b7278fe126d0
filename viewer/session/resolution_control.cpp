#include "viewer/session/resolution_control.h"

#include <algorithm>

namespace whit::view {

constexpr double kNewest = 0.3;  // weight of the newest frame in the mean cost

void ResolutionControl::setRate(double framesPerSecond) {
  rate_ = std::clamp(framesPerSecond, kLeastRate, kLargestRate);
}

void ResolutionControl::learn(double ms, double samples, bool plain) {
  if (!(ms > 0) || !(samples > 0)) return;
  const double cost = ms / samples;
  if (msPerSample_ == 0) {
    msPerSample_ = cost;  // an upper bound if rays are sampled
  } else if (plain || !raysAreSampled_) {
    msPerSample_ = std::lerp(msPerSample_, cost, kNewest);
  } else {
    const double factor = std::lerp(sampledRaysFactor_, cost / msPerSample_, kNewest);
    sampledRaysFactor_ = std::max(factor, 1.0);
  }
}

double ResolutionControl::predictMs(const Sharpness& step) const {
  const double factor = raysAreSampled_ && !step.plain ? sampledRaysFactor_ : 1;
  return factor * msPerSample_ * windowPixels_ * step.scale * step.scale * step.spp;
}

std::vector<Sharpness> ResolutionControl::stepsInMotion() const {
  std::vector<Sharpness> steps;
  for (int spp = spp_; spp > 1; spp /= 2) steps.push_back({1, spp});
  if (raysAreSampled_) steps.push_back({1, 1});
  for (const double scale : kScales) steps.push_back({scale, 1, raysAreSampled_});
  return steps;
}

Sharpness ResolutionControl::moving(double windowPixels) {
  windowPixels_ = windowPixels;
  const double frameMs = 1000 / rate_;
  const std::vector<Sharpness> steps = stepsInMotion();
  const std::size_t cheapest = steps.size() - 1;
  if (msPerSample_ == 0) return steps[cheapest];

  level_ = std::min(level_, cheapest);
  if (level_ > 0 && predictMs(steps[level_ - 1]) < kHeadroom * frameMs) {
    --level_;
  } else {
    while (level_ < cheapest && predictMs(steps[level_]) > frameMs) ++level_;
  }

  // A link may carry fewer pixels than the machine can trace.
  const double most = std::sqrt(mostPixels_ / windowPixels_);
  while (level_ < cheapest && steps[level_].scale > most) ++level_;
  return steps[level_];
}

std::vector<Sharpness> ResolutionControl::stepsAtRest(bool supersample) const {
  std::vector<Sharpness> steps;
  steps.reserve(kCoarseScales.size() + 1 + kStillSppFactors.size());
  for (const double scale : kCoarseScales) steps.push_back({scale, 1});
  if (spp_ > 1) steps.push_back({1, 1});

  const std::size_t factors = noisy_ ? kStillSppFactors.size() : kUnsampledSppFactors;
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
  const auto soonThere = [&](const Sharpness& step) {
    return msPerSample_ > 0 && predictMs(step) <= kFirstStillMs;
  };

  while (step_ + 1 < steps.size() &&
         (soonThere(steps[step_ + 1]) || steps[step_].scale < shownScale)) {
    ++step_;
  }
}

}  // namespace whit::view
