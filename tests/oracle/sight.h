// What comes along a ray.
#pragma once

#include "oracle/vector.h"

namespace oracle {

struct Sight {
  Color radiance{};
  // How much of it went through a surface whose vertex normals point elsewhere than its plane, so
  // that a ray cannot go where they say: what then happens no formula decides.
  double undecided = 0;
  double brightest = 0;  // of all rays that were followed
  // Of what whit takes samples `radiance` is the expectation. How far whit's mean may be from it:
  // the variance of both sides' points; the most that one of them can bring, where that is known,
  // and the most that one ray counts for.
  Color variance{};
  double largestSample = 0, largestShare = 0;
  // Radiance that counts by an albedo, or what an albedo leaves, which whit looks up in a table.
  double tabled = 0;
};

inline Sight operator+(const Sight& a, const Sight& b) {
  return {a.radiance + b.radiance,
          a.undecided + b.undecided,
          std::max(a.brightest, b.brightest),
          a.variance + b.variance,
          std::max(a.largestSample, b.largestSample),
          std::max(a.largestShare, b.largestShare),
          a.tabled + b.tabled};
}
inline Sight& operator+=(Sight& a, const Sight& b) { return a = a + b; }
inline Sight operator*(const Sight& a, const Color& part) {
  const double most = largest(part);
  return {a.radiance * part,      a.undecided * most,    a.brightest,    a.variance * part * part,
          a.largestSample * most, a.largestShare * most, a.tabled * most};
}

}  // namespace oracle
