// The control of the resolution: how finely to trace the next frame. Pure: knows neither window nor
// clock.
//
// In motion, a scale of the window's size that holds the wanted frame rate, judged by what recent
// samples cost; fewer samples where the coarsest scale does not. At rest, step by step: all pixels,
// then 4 and 16 times the samples.
#pragma once

#include <array>

namespace whit::view {

struct Sharpness {
  double scale = 1;  // of the window's sides
  int spp = 1;
  bool operator==(const Sharpness&) const = default;
};

inline constexpr double kLeastRate = 20, kDefaultRate = 60, kLargestRate = 240;
inline constexpr std::array kScales{1.0, 0.875, 0.75, 0.625, 0.5, 0.375, 0.25, 0.1875, 0.125};
inline constexpr std::array kStillSppFactors{1, 4, 16};
inline constexpr double kSettleSeconds = 0.2;  // at rest for so long before it sharpens
// A finer scale must promise to stay below this share of the frame time, lest it be taken back.
inline constexpr double kHeadroom = 0.85;

class ResolutionControl {
 public:
  ResolutionControl(double framesPerSecond, int spp) : spp_(spp) { setRate(framesPerSecond); }

  void setRate(double framesPerSecond);  // brought into [kLeastRate, kLargestRate]
  double rate() const { return rate_; }
  void setSpp(int spp) { spp_ = spp; }

  // The largest scale, also at rest: `steps` towards finer (positive) or coarser pixels.
  void stepLargestScale(int steps);
  double largestScale() const { return kScales[largest_]; }

  // What a frame of so many pixels (times samples) took to trace.
  void learn(double ms, double samples);

  // For a window of so many pixels. The frame has to wait `waitMs` for its turn, and is coarser for
  // it, so that it is there in time all the same.
  Sharpness moving(double windowPixels, double waitMs = 0);
  Sharpness still() const;
  // To the next step at rest; false when there is none.
  bool sharpen();
  void restartSharpening() { step_ = 0; }

 private:
  double predictMs(std::size_t level, double windowPixels) const;

  double rate_ = kDefaultRate;
  int spp_;
  std::size_t largest_ = 0, level_ = 0;  // of kScales
  std::size_t step_ = 0;                 // of kStillSppFactors
  double msPerSample_ = 0;               // 0: nothing learned yet
};

}  // namespace whit::view
