// Level surfels with a glossy lobe, random points for its samples, and formulas to compare it with.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "core/index.h"
#include "pi.h"
#include "reference/find_radiance_and_shadow_rays.h"
#include "sampling/ggx_lobe.h"
#include "textbook_fresnel.h"
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

// A direction that leans away from the z axis by up to 55 degrees.
inline Vec3d bentNormal(verify::Numbers& numbers) {
  const double x = numbers.in(-1, 1), y = numbers.in(-1, 1);
  return normalized(Vec3d(x, y, 1));
}

inline UnitPoint pointOf(verify::Numbers& numbers) {
  const auto u = static_cast<float>(numbers.in(0, 1)), v = static_cast<float>(numbers.in(0, 1));
  return {u, v};
}

// The one of `cells` equal parts of [0, 1] that a number is in.
inline std::size_t cellOf(double number, int cells) {
  return static_cast<std::size_t>(std::clamp(static_cast<int>(number * cells), 0, cells - 1));
}

// Pearson's test of how often each cell was drawn against the expected numbers.
inline void expectDistributed(std::span<const double> seen, std::span<const double> expected) {
  double chiSquared = 0, pooledSeen = 0, pooledExpected = 0;
  int freedom = -1;
  for (const std::size_t i : indices(seen)) {
    // Too few for the normal approximation are taken together.
    if (expected[i] < 20) {
      pooledSeen += seen[i];
      pooledExpected += expected[i];
      continue;
    }
    chiSquared += (seen[i] - expected[i]) * (seen[i] - expected[i]) / expected[i];
    ++freedom;
  }

  EXPECT_GT(freedom, 7);
  // The bound is five standard deviations of the statistic above its mean.
  EXPECT_LT(chiSquared, freedom + 5 * std::sqrt(2.0 * freedom));
  EXPECT_NEAR(pooledSeen, pooledExpected, 5 * std::sqrt(pooledExpected) + 5);
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

}  // namespace whit::reference
