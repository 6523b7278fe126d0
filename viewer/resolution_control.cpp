#include "viewer/resolution_control.h"

#include <algorithm>
#include <limits>

namespace whit::view {

namespace {

constexpr double kNewest = 0.3;  // weight of the newest frame in the mean cost

}  // namespace

void ResolutionControl::setRate(double framesPerSecond) {
  rate_ = std::clamp(framesPerSecond, kLeastRate, kLargestRate);
}

void ResolutionControl::stepLargestScale(int steps) {
  const int last = static_cast<int>(kScales.size()) - 1;
  largest_ = static_cast<std::size_t>(std::clamp(static_cast<int>(largest_) - steps, 0, last));
  level_ = std::max(level_, largest_);
}

bool ResolutionControl::learned() const {
  return std::any_of(msPerSample_.begin(), msPerSample_.end(), [](double ms) { return ms > 0; });
}

void ResolutionControl::learn(double ms, double samples, int depth) {
  if (!(ms > 0) || !(samples > 0)) return;
  const double cost = ms / samples;
  std::size_t tier = 0;
  while (tier + 1 < kMotionDepths.size() && depth <= kMotionDepths[tier + 1]) ++tier;
  if (depth >= depth_) tier = 0;
  const double before = msPerSample_[tier];
  const double now = before > 0 ? before + kNewest * (cost - before) : cost;
  msPerSample_[tier] = now;
  if (before == 0) return;
  // A view that became more expensive did so at all depths.
  for (std::size_t other = 0; other < msPerSample_.size(); ++other) {
    if (other != tier) msPerSample_[other] *= now / before;
  }
}

// A tier that was not traced yet costs at most as much as a larger depth, and is assumed to cost
// kDearer times as much as the next smaller one.
double ResolutionControl::costOf(std::size_t tier) const {
  constexpr double kDearer = 2;
  double most = std::numeric_limits<double>::infinity(), factor = 1;
  for (std::size_t other = 0; other <= tier; ++other) {
    if (msPerSample_[other] > 0) most = msPerSample_[other];
  }
  if (msPerSample_[tier] > 0) return most;
  for (std::size_t other = tier + 1; other < msPerSample_.size(); ++other) {
    factor *= kDearer;
    if (msPerSample_[other] > 0) return std::min(most, factor * msPerSample_[other]);
  }
  return most;
}

double ResolutionControl::predictMs(double scale) const {
  return costOf(tier_) * windowPixels_ * scale * scale * spp_;
}

void ResolutionControl::chooseLevel(double frameMs) {
  const std::size_t coarsest = kScales.size() - 1;
  if (level_ > largest_ && predictMs(kScales[level_ - 1]) < kHeadroom * frameMs) {
    --level_;
  } else {
    while (level_ < coarsest && predictMs(kScales[level_]) > frameMs) ++level_;
  }
}

// Takes the largest depth at which the picture is legible, or else the smallest; but the full depth
// where that saves little.
void ResolutionControl::chooseDepth(double frameMs) {
  const double scale = kScales[std::max(largest_, kLegibleLevel)];
  const std::size_t before = tier_;
  std::vector<std::size_t> tiers{0};
  for (std::size_t tier = 1; tier < kMotionDepths.size(); ++tier) {
    if (kMotionDepths[tier] < depth_) tiers.push_back(tier);
  }
  const auto holds = std::find_if(tiers.begin(), tiers.end(), [&](std::size_t tier) {
    tier_ = tier;
    return predictMs(scale) <= (tier < before ? kHeadroom : 1) * frameMs;
  });
  tier_ = holds == tiers.end() ? tiers.back() : *holds;
  if (msPerSample_[0] > 0 && costOf(tier_) > (1 - kDepthSaves) * msPerSample_[0]) tier_ = 0;
}

Sharpness ResolutionControl::moving(double windowPixels) {
  windowPixels_ = windowPixels;
  const double frameMs = 1000 / rate_;
  const std::size_t coarsest = kScales.size() - 1;
  if (!learned()) return {kScales[coarsest], 1, kFirstDepth};  // cheap in any scene
  chooseDepth(frameMs);
  chooseLevel(frameMs);
  Sharpness chosen{kScales[level_], spp_, kMotionDepths[tier_]};
  if (level_ < coarsest) return chosen;
  const double share = frameMs / predictMs(chosen.scale);
  if (share < 1) chosen.spp = std::max(static_cast<int>(spp_ * share), 1);
  return chosen;
}

std::vector<Sharpness> ResolutionControl::stepsAtRest(bool supersample) const {
  std::vector<Sharpness> steps;
  for (const double scale : kCoarseScales) {
    if (scale < largestScale()) steps.push_back({scale, spp_});
  }
  const std::size_t factors = sampled_ ? kStillSppFactors.size() : kUnsampledSppFactors;
  for (std::size_t i = 0; i < (supersample ? factors : 1); ++i) {
    steps.push_back({largestScale(), std::min(spp_ * kStillSppFactors[i], kSppLimit)});
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
  tier_ = 0;
  step_ = 0;
  const std::vector<Sharpness> steps = stepsAtRest(false);
  const auto soonThere = [&](double scale) {
    return learned() && predictMs(scale) <= kFirstStillMs;
  };
  while (step_ + 1 < steps.size() &&
         (soonThere(steps[step_ + 1].scale) || steps[step_].scale < shownScale)) {
    ++step_;
  }
}

}  // namespace whit::view
