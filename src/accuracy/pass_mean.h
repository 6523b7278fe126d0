// The mean of pictures that differ by their noise alone, and how far off it is itself.
#pragma once

#include <vector>

#include "core/image.h"

namespace whit::accuracy {

// Of the picture with all transport; an even number, so that both halves are alike.
inline constexpr int kTransportPasses = 8;

// Passes are independent pictures of one view: each has random numbers of its own.
class PassMean {
 public:
  // `shape` gives size and window.
  explicit PassMean(const Image& shape);

  void add(const Image& pass);
  int passes() const { return passes_; }

  // Of one pass or more, linear radiance.
  Image mean() const;
  // Of the passes with even, or odd, numbers: two pictures with half as many, to tell how visible
  // noise is. Of two passes or more.
  Image half(bool odd) const;
  // The standard error of the mean, from two passes or more: the root of a value's sample variance
  // over the number of passes, its root mean square over pixels and channels. Linear radiance.
  double standardError() const;
  // The mean over pixels and channels.
  double meanRadiance() const;

 private:
  Image picture(const std::vector<RgbD>& sums, int passes) const;

  Image shape_;
  int passes_ = 0;
  // A pixel each: the mean so far, the squared deviations from it (Welford 1962), and sums of every
  // other pass.
  std::vector<RgbD> mean_, deviations_, evens_, odds_;
};

}  // namespace whit::accuracy
