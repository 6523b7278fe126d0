// Sums of the samples of each pixel, for pictures that gain samples over time.
#pragma once

#include <cstddef>
#include <vector>

#include "core/image.h"

namespace whit {

// Samples of the pattern, [first, end).
struct SampleRange {
  int first = 0, end = 0;
  int count() const { return end - first; }
};

struct SampleSum {
  RgbD total;          // in the order of the pattern
  double squares = 0;  // of the samples' mean channel, linear radiance
};

// The sums of a window's pixels; they start empty.
class SampleSums {
 public:
  explicit SampleSums(const Crop& window)
      : window_(window),
        sums_(static_cast<std::size_t>(window.x1 - window.x0) *
              static_cast<std::size_t>(window.y1 - window.y0)) {}

  SampleSum& at(int x, int y) { return sums_[index(x, y)]; }
  const Crop& window() const { return window_; }

  // The standard error of the mean of `samples` samples a pixel, 2 or more: its mean over the
  // window, as a share of the window's mean radiance (of the mean channel). As if samples were
  // independent; spread evenly, as those of a pattern are, they are off by less. Not its root mean
  // square, which a few bright samples decide. 0 for black.
  double relativeError(int samples) const;

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - window_.y0) *
               static_cast<std::size_t>(window_.x1 - window_.x0) +
           static_cast<std::size_t>(x - window_.x0);
  }

  Crop window_;
  std::vector<SampleSum> sums_;
};

}  // namespace whit
