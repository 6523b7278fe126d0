#include "oracle/integral.h"

namespace oracle {

namespace {

// Of values whose squares have this mean.
Color varianceOf(const Color& meanSquare, const Color& mean) {
  const Color variance = meanSquare - mean * mean;
  return {std::max(0.0, variance.x), std::max(0.0, variance.y), std::max(0.0, variance.z)};
}

}  // namespace

void Integral::add(const Sight& seen, const Color& part, double ratio) {
  ++points_;
  const Sight there = seen * part;
  sum_ += there.radiance;
  squares_ += there.radiance * there.radiance;
  squaresOfSamples_ += (there.radiance * there.radiance + there.variance) * ratio;
  undecided_ += there.undecided;
  brightest_ = std::max(brightest_, seen.brightest);
  largest_ = std::max(largest_, largest(part));
  largestOfSamples_ = std::max(largestOfSamples_, largest(part) * ratio);
}

Sight Integral::mean(int samples) const {
  Sight sight;
  sight.radiance = sum_ / points_;
  sight.undecided = undecided_ / points_;
  sight.brightest = brightest_;
  sight.variance = varianceOf(squaresOfSamples_ / points_, sight.radiance) / samples +
                   varianceOf(squares_ / points_, sight.radiance) / (points_ - 1);
  sight.largestSample = std::max(largestOfSamples_ / samples, largest_ / points_);
  return sight;
}

}  // namespace oracle
