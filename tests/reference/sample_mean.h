// The mean of independent samples and its standard error.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace whit::test {

class SampleMean {
 public:
  // Welford's update, which does not cancel large squares.
  void add(double value) {
    ++count_;
    const double before = value - mean_;
    mean_ += before / static_cast<double>(count_);
    squares_ += before * (value - mean_);
  }

  double value() const { return mean_; }
  double error() const {
    const auto n = static_cast<double>(count_);
    return std::sqrt(squares_ / ((n - 1) * n));
  }

 private:
  std::size_t count_ = 0;
  double mean_ = 0, squares_ = 0;
};

// Returns the mean of sample(path) over the paths of these numbers.
template <typename Sample>
SampleMean meanOf(std::uint32_t paths, const Sample& sample) {
  SampleMean mean;
  for (std::uint32_t path = 0; path < paths; ++path) mean.add(sample(path));
  return mean;
}

}  // namespace whit::test
