// Chooses the resolution and samples of the next frame. It knows neither window nor clock.
//
// In motion it holds the frame rate, judging by the cost of recent samples. It first gives up what
// the eye misses least: samples down to one a pixel, then rays that are sampled, then resolution.
// At rest it goes step by step through 1/8, 1/4, 1/2 and all of the window's pixels with one sample
// each, beginning with a step that takes little time, then through 1, 4 and 16 times the samples
// that were asked for, and where rays are sampled 64 and 256 times.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/options.h"

namespace whit::view {

struct Sharpness {
  double scale = 1;  // factor of the window's sides
  int spp = 1;
  bool plain = false;  // without sampled rays
  bool operator==(const Sharpness&) const = default;
};

inline constexpr double kLeastRate = 20, kDefaultRate = 60, kFewCoresRate = 30, kLargestRate = 240;
inline constexpr int kFewCores = 4;
inline constexpr double defaultRate(int cores) {
  return cores > kFewCores ? kDefaultRate : kFewCoresRate;
}
inline constexpr std::array kScales{1.0, 0.9375, 0.875, 0.8125, 0.75, 0.6875, 0.625, 0.5625,
                                    0.5, 0.4375, 0.375, 0.3125, 0.25, 0.1875, 0.125};
inline constexpr std::array kCoarseScales{0.125, 0.25, 0.5};  // at rest
inline constexpr std::array kStillSppFactors{1, 4, 16, 64, 256};
inline constexpr std::size_t kUnsampledSppFactors = 3;  // factors used where no rays are sampled
inline constexpr double kFirstStillMs = 50;             // limit for the first picture at rest
inline constexpr double kSettleSeconds = 0.06;          // rest before the picture sharpens
// A finer scale is taken if its expected time is below this share of the frame time; otherwise it
// would soon be taken back.
inline constexpr double kHeadroom = 0.92;

class ResolutionControl {
 public:
  ResolutionControl(double framesPerSecond, int spp) : spp_(spp) { setRate(framesPerSecond); }

  void setRate(double framesPerSecond);  // brought into [kLeastRate, kLargestRate]
  double rate() const { return rate_; }
  // Sets the samples asked for, and whether they have sampled rays, which can be left out.
  void setSamples(int spp, bool raysAreSampled) {
    spp_ = spp;
    raysAreSampled_ = raysAreSampled;
  }
  // Limits pictures in motion where a link cannot carry more.
  void setMostPixels(double pixels) { mostPixels_ = pixels; }
  // Pictures with noise get more samples at rest.
  void setNoisy(bool noisy) { noisy_ = noisy; }

  // Notes the time of a frame with this number of samples; `plain`: without sampled rays.
  void learn(double ms, double samples, bool plain = false);

  // Returns the choice for a frame in motion.
  Sharpness moving(double windowPixels);
  // Returns the present step at rest; without `supersample` it has the options' samples at most.
  Sharpness still(bool supersample) const;
  // Goes to the next step; returns false when there is none.
  bool sharpen(bool supersample);
  // Goes to the first step at rest: one that takes little time, but is no coarser than the picture
  // that is shown, whose scale is given (0: it shows something else).
  void startSharpening(double windowPixels, double shownScale);

 private:
  double predictMs(const Sharpness& step) const;
  std::vector<Sharpness> stepsInMotion() const;
  std::vector<Sharpness> stepsAtRest(bool supersample) const;

  double rate_ = kFewCoresRate;
  int spp_;
  bool raysAreSampled_ = false;  // the options ask for sampled rays
  bool noisy_ = false;           // the last picture had noise
  std::size_t level_ = 0;        // index of the steps in motion
  std::size_t step_ = 0;         // index of the steps at rest
  double windowPixels_ = 0, mostPixels_ = 1e9;
  double msPerSample_ = 0;  // time of a plain sample; 0: not known yet
  // Plain samples that cost as much as one with sampled rays; a guess until one was traced.
  double sampledRaysFactor_ = 4;
};

}  // namespace whit::view
