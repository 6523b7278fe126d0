// Level surfels with a glossy lobe, random points for its samples, and formulas and integrals to
// compare it with.
#pragma once

#include <algorithm>
#include <cmath>

#include "pi.h"
#include "reference/find_radiance_and_shadow_rays.h"
#include "sampling/ggx_lobe.h"
#include "verify/scene_builder.h"

namespace whit::reference {

// The unit vector that has this cosine to the z axis.
inline Vec3d directionAt(double cosine, double turn) {
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return {sine * std::cos(turn), sine * std::sin(turn), cosine};
}

inline Surfel levelSurfel(double alpha, double f0, const Vec3d& view) {
  Surfel s;
  s.geometricNormal = s.shadingNormal = {0, 0, 1};
  s.view = view;
  s.alpha = alpha;
  s.specular = RgbD(f0);
  return s;
}

inline UnitPoint pointOf(verify::Numbers& numbers) {
  const auto u = static_cast<float>(numbers.in(0, 1)), v = static_cast<float>(numbers.in(0, 1));
  return {u, v};
}

// The share of facets per solid angle whose normal has this cosine (Walter et al. 2007, eq. 33).
inline double facetsOf(double alpha, double cosine) {
  const double a2 = alpha * alpha, spread = cosine * cosine * (a2 - 1) + 1;
  return a2 / (kPi * spread * spread);
}

// The share of facets that are seen from a direction with this cosine (eq. 34).
inline double smithG1(double alpha, double cosine) {
  const double tangent2 = 1 / (cosine * cosine) - 1;
  return 2 / (1 + std::sqrt(1 + alpha * alpha * tangent2));
}

// The density of visible normals by solid angle: G1(v) max(0, v.m) D(m) / (v.n) (Heitz 2018, eq.
// 3).
inline double visibleDensity(double alpha, const Vec3d& view, const Vec3d& m) {
  return smithG1(alpha, view.z) * std::max(0.0, dot(view, m)) * facetsOf(alpha, m.z) / view.z;
}

// The lobe's albedo: the share of white light from all sides that it sends to the viewer, by the
// midpoint rule over cosines and angles.
inline double albedoByQuadrature(const Surfel& s) {
  constexpr int kRows = 600, kColumns = 400;
  double sum = 0;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const double c = (row + 0.5) / kRows;
      sum += glossyLobe(s, directionAt(c, 2 * kPi * (column + 0.5) / kColumns)).x * c;
    }
  }
  return sum * 2 * kPi / (kRows * kColumns);
}

}  // namespace whit::reference
