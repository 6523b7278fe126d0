// Integrals that whit takes random samples of, by the oracle's own points.
#pragma once

#include "oracle/random_parts.h"
#include "oracle/sight.h"

namespace oracle {

class Integral {
 public:
  // A point of the oracle's: the integrand is `part` of what is seen there, over the density that
  // the point was drawn with, which is `ratio` times the density of whit's samples there.
  void add(const Sight& seen, const Color& part, double ratio);
  // The same of a light's points: `part` is what comes from there unless something is between.
  void addLight(bool lit, const Color& part, double ratio);
  // A point at which the integrand is 0.
  void addNothing() { ++points_; }

  int points() const { return points_; }

  // Of so many independent samples of whit's. The variance of the oracle's points is that of as
  // many independent ones; that they are spread evenly makes it no larger.
  Sight mean(int samples) const;

 private:
  int points_ = 0;
  Color sum_, squares_;
  Color squaresOfSamples_;  // expected of whit's, from the same points
  void addSquares(const Sight& there, double ratio);

  double undecided_ = 0, brightest_ = 0;
  double largestShare_ = 0, largestShareOfSamples_ = 0;  // of rays
};

// visit(u, v) for a point in each of side * side cells of the unit square.
template <typename Visit>
void forEvenPoints(int side, Random& random, const Visit& visit) {
  for (int i = 0; i < side; ++i) {
    for (int k = 0; k < side; ++k) {
      const double u = random.between(0, 1), v = random.between(0, 1);
      visit((i + u) / side, (k + v) / side);
    }
  }
}

}  // namespace oracle
