#include "oracle/integral.h"

namespace oracle {

namespace {

// Of values whose squares have this mean.
Color varianceOf(const Color& meanSquare, const Color& mean) {
  return eachOf([](double square, double m) { return std::max(0.0, square - m * m); }, meanSquare,
                mean);
}

}  // namespace

void Integral::add(const Sight& seen, const Color& part, double ratio) {
  addSquares(seen * part, ratio);
  brightest_ = std::max(brightest_, seen.brightest);
  largestShare_ = std::max(largestShare_, largest(part));
  largestShareOfSamples_ = std::max(largestShareOfSamples_, largest(part) * ratio);
}

void Integral::addLight(bool lit, const Color& part, double ratio) {
  addSquares({.radiance = lit ? part : Color{}}, ratio);
}

void Integral::addSquares(const Sight& there, double ratio) {
  ++points_;
  sum_ += there.radiance;
  squares_ += there.radiance * there.radiance;
  squaresOfSamples_ += (there.radiance * there.radiance + there.variance) * ratio;
  undecided_ += there.undecided;
}

Sight Integral::mean(int samples) const {
  Sight sight;
  sight.radiance = sum_ / points_;
  sight.undecided = undecided_ / points_;
  sight.brightest = brightest_;

  // A single point says nothing of the variance: who draws one compares many pixels instead.
  if (points_ > 1) {
    sight.variance = varianceOf(squaresOfSamples_ / points_, sight.radiance) / samples +
                     varianceOf(squares_ / points_, sight.radiance) / (points_ - 1);
  }

  sight.largestShare = std::max(largestShareOfSamples_ / samples, largestShare_ / points_);
  return sight;
}

}  // namespace oracle
