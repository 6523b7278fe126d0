// A test that two random estimates have the same expectation.
#pragma once

#include <cmath>

#include "oracle/vector.h"

namespace oracle {

// The paired t-test (Student 1908): the differences of the pairs are independent, and their mean is
// 0 if nothing is wrong. Their spread says how far from 0 the mean may be.
class Paired {
 public:
  void add(const Color& difference) {
    ++count_;
    sum_ += difference;
    squares_ += difference * difference;
  }

  Color mean() const { return sum_ / count_; }
  // Returns the variance of the mean.
  Color variance() const {
    const auto of = [&](double sum, double squares) {
      return std::max(0.0, squares / count_ - sum / count_ * (sum / count_)) / (count_ - 1);
    };
    return eachOf(of, sum_, squares_);
  }

 private:
  int count_ = 0;
  Color sum_, squares_;
};

// The mean in standard errors, to which `rounding` adds.
inline Color standardErrors(const Color& mean, const Color& variance, double rounding) {
  const auto of = [&](double m, double v) { return m / std::sqrt(v + rounding * rounding); };
  return eachOf(of, mean, variance);
}

}  // namespace oracle
