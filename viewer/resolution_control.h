// The control of the resolution: how finely to trace the next frame. Pure: knows neither window nor
// clock.
//
// In motion, a scale of the window's size that holds the wanted frame rate, judged by what recent
// samples cost. Where that would be mush a smaller depth pays for resolution, and where the
// coarsest scale is still too slow, fewer samples. At rest, step by step: 1/8, 1/4, 1/2 and all of
// the window's pixels, beginning with what is soon there, then 4 and 16 times the samples; where
// rays are sampled, 64 and 256 times as well.
#pragma once

#include <array>
#include <cstddef>

#include "core/options.h"

namespace whit::view {

struct Sharpness {
  double scale = 1;  // of the window's sides
  int spp = 1;
  int depth = kDepthLimit;  // or the options', whichever is less
  bool operator==(const Sharpness&) const = default;
};

inline constexpr double kLeastRate = 20, kDefaultRate = 60, kFewCoresRate = 30, kLargestRate = 240;
inline constexpr int kFewCores = 4;
inline constexpr double defaultRate(int cores) {
  return cores > kFewCores ? kDefaultRate : kFewCoresRate;
}
inline constexpr std::array kScales{1.0, 0.875, 0.75, 0.625, 0.5, 0.375, 0.25, 0.1875, 0.125};
inline constexpr std::size_t kLegibleLevel = 4;  // of kScales: what is coarser is mush
inline constexpr std::array kMotionDepths{kDepthLimit, 8, 4};
inline constexpr int kFirstDepth = 4;  // of these, before anything is known
// Time that a smaller depth must save, as a share, to be worth what it leaves out.
inline constexpr double kDepthSaves = 0.15;
inline constexpr std::array kCoarseScales{0.125, 0.25, 0.5};  // at rest
inline constexpr std::array kStillSppFactors{1, 4, 16, 64, 256};
inline constexpr std::size_t kUnsampledSppFactors = 3;  // of these, where nothing is sampled
inline constexpr double kFirstStillMs = 50;             // what the first picture at rest may take
inline constexpr double kSettleSeconds = 0.06;          // at rest for so long before it sharpens
// A finer scale must promise to stay below this share of the frame time, lest it be taken back.
inline constexpr double kHeadroom = 0.85;

class ResolutionControl {
 public:
  ResolutionControl(double framesPerSecond, int spp) : spp_(spp) { setRate(framesPerSecond); }

  void setRate(double framesPerSecond);  // brought into [kLeastRate, kLargestRate]
  double rate() const { return rate_; }
  void setSpp(int spp) { spp_ = spp; }
  void setDepth(int depth) { depth_ = depth; }
  // Whether rays are drawn at random: noise goes with many samples only.
  void setSampled(bool sampled) { sampled_ = sampled; }

  // The largest scale, also at rest: `steps` towards finer (positive) or coarser pixels.
  void stepLargestScale(int steps);
  double largestScale() const { return kScales[largest_]; }

  // What a frame of so many pixels (times samples) took to trace, no deeper than that.
  void learn(double ms, double samples, int depth = kDepthLimit);

  // For a window of so many pixels. The frame has to wait `waitMs` for its turn, and is coarser for
  // it, so that it is there in time all the same.
  Sharpness moving(double windowPixels, double waitMs = 0);
  // The present step at rest; without `supersample` no more samples than those asked for.
  Sharpness still(bool supersample) const;
  // To the next step; false when there is none.
  bool sharpen(bool supersample);
  // To the first step for a window of so many pixels: what takes little time, but no coarser than
  // the picture that is there already, of that scale (0: it shows something else).
  void startSharpening(double windowPixels, double shownScale);
  // Whether finer pixels are still to come.
  bool coarse() const { return step_ < fullStep(); }

 private:
  bool learned() const;
  double costOf(std::size_t tier) const;  // a sample, ms
  double predictMs(double scale) const;
  void chooseLevel(double frameMs);
  void chooseDepth(double frameMs);
  std::size_t fullStep() const;
  double scaleOf(std::size_t step) const;
  std::size_t lastStep(bool supersample) const;

  double rate_ = kFewCoresRate;
  int spp_, depth_ = kDepthLimit;
  bool sampled_ = false;
  std::size_t largest_ = 0, level_ = 0;  // of kScales
  std::size_t tier_ = 0;                 // of kMotionDepths
  std::size_t step_ = 0;                 // of the scales at rest, then the samples
  double windowPixels_ = 0;
  std::array<double, kMotionDepths.size()> msPerSample_{};  // 0: nothing learned yet
};

}  // namespace whit::view
