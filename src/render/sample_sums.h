// The sums of pictures that gain samples over time.
#pragma once

#include <vector>

#include "core/image.h"
#include "core/vec3.h"

namespace whit {

struct SampleSum {
  RgbD total;          // sum in the order of the pattern
  double squares = 0;  // sum over the samples of the mean of r^2, g^2 and b^2, linear radiance
  // Returns the standard error of the mean of `samples` samples, as if they were independent: the
  // root mean square of those of r, g and b. It is infinite for one sample.
  double standardError(int samples) const;
};

// The sums of a window's pixels, for pictures that gain samples over time. They start empty.
class SampleSums {
 public:
  explicit SampleSums(const Crop& window)
      : sums_(cellsOf(window.x1 - window.x0, window.y1 - window.y0)) {
    shape_.window = window;
  }

  SampleSum& at(int x, int y) { return sums_[shape_.index(x, y)]; }
  const Crop& window() const { return shape_.window; }

  // Returns the standard error of a pixel's mean of `samples` samples, 2 or more, as the mean over
  // the window divided by the window's mean radiance (of the mean channel); 0 for a black window.
  // It takes samples for independent, so it overestimates the error of evenly spread ones. It is no
  // root mean square, because a few bright samples would decide that.
  double relativeError(int samples) const;

 private:
  Image shape_;  // without pixels
  std::vector<SampleSum> sums_;
};

}  // namespace whit
