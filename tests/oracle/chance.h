// How far random samples may be from what is expected of them.
#pragma once

#include <cmath>
#include <functional>

#include "oracle/sight.h"

namespace oracle {

// Of one comparison to fail by chance: there are some 1e5 of them.
inline constexpr double kRisk = 1e-9;

// Bernstein's inequality: a sum of independent numbers, each no farther than `largest` from its
// expectation, is farther from its own than this with no more probability than kRisk.
inline double chance(double variance, double largest) {
  const double risk = std::log(2 / kRisk), jumps = risk * largest / 3;
  return jumps + std::sqrt(jumps * jumps + 2 * risk * variance);
}

// The most that one sample brings to what is seen.
inline double largestSample(const Sight& sight, double brightest) {
  return std::max(sight.largestSample, sight.largestShare * brightest);
}

// Pixels together: what is wrong in each of them adds up, while their noise cancels out.
class Sum {
 public:
  // `rounding` is by how much whit may be off without any noise, `brightest` the most that a sample
  // may meet.
  void add(const Color& got, const Sight& wanted, double rounding, double brightest) {
    ++pixels_;
    wanted_ += wanted.radiance;
    off_ += got - wanted.radiance;
    variance_ += wanted.variance;
    largestSample_ = std::max(largestSample_, oracle::largestSample(wanted, brightest));
    rounding_ += rounding;
  }

  int pixels() const { return pixels_; }

  // In parts of what is allowed, of the worst channel.
  double worst() const {
    const auto part = [](double off, double of) { return of > 0 ? std::abs(off) / of : 0; };
    return largest(eachOf(part, off_, allowed()));
  }

  // What is allowed, in parts of what is seen.
  double largestTolerance() const { return largest(eachOf(std::divides(), allowed(), wanted_)); }

 private:
  Color allowed() const {
    const auto of = [&](double variance) { return rounding_ + chance(variance, largestSample_); };
    return eachOf(of, variance_);
  }

  int pixels_ = 0;
  Color wanted_, off_, variance_;
  double largestSample_ = 0, rounding_ = 0;
};

}  // namespace oracle
