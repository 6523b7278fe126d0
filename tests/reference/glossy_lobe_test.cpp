// The glossy lobe: closed forms, reciprocity, energy.
#include <gtest/gtest.h>

#include <cmath>

#include "reference/lobe.h"
#include "reference/small_scenes.h"

namespace whit::reference {
namespace {

// Everything along the normal: D = 1 / (pi a^2), V = 1/4, F = F0.
TEST(GlossyLobe, PeakAlongTheNormal) {
  for (const double alpha : {0.1, 0.5, 1.0}) {
    const RgbD lobe = glossyLobe(levelSurfel(alpha, 0.04, {0, 0, 1}), {0, 0, 1});
    EXPECT_NEAR(lobe.x, 0.04 / (4 * kPi * alpha * alpha), 1e-12) << alpha;
  }
}

TEST(GlossyLobe, IsReciprocal) {
  test::Numbers numbers(10);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d a = directionAt(numbers.in(0.01, 1), numbers.in(0, 6)),
                b = directionAt(numbers.in(0.01, 1), 0);
    const double there = glossyLobe(levelSurfel(0.3, 0.5, a), b).x;
    EXPECT_NEAR(glossyLobe(levelSurfel(0.3, 0.5, b), a).x, there, 1e-12 * there);
  }
}

// With F = 1 a single bounce between facets loses some energy and never gains any.
TEST(GlossyLobe, ReflectsAtMostAllLight) {
  for (const double alpha : {0.2, 0.5, 1.0}) {
    for (const double viewCosine : {0.05, 0.5, 1.0}) {
      // 0.002: the midpoint rule on the sharpest of these lobes.
      EXPECT_LT(albedoByQuadrature(levelSurfel(alpha, 1, directionAt(viewCosine, 0))), 1.002)
          << alpha << ' ' << viewCosine;
    }
  }
  // The roughest, seen along the normal: integral of c / (1 + c) over [0, 1].
  EXPECT_NEAR(albedoByQuadrature(levelSurfel(1, 1, {0, 0, 1})), 1 - std::log(2.0), 1e-6);
}

TEST(GlossyLobe, AddsToTheDiffusePart) {
  Surfel s = levelSurfel(0.25, 0.04, {0, 0, 1});
  s.diffuse = RgbD(0.5);
  const Light light = test::lightAt({0, 0, 2}, 4);
  const double lobe = 0.04 / (4 * kPi * 0.0625);

  EXPECT_NEAR(radianceFromLight(EffectSet::all(), s, light).radiance.x, 0.5 / kPi + lobe, 1e-12);
  const EffectSet matte = EffectSet::all().without(Effect::glossy);
  EXPECT_NEAR(radianceFromLight(matte, s, light).radiance.x, 0.5 / kPi, 1e-12);
}

}  // namespace
}  // namespace whit::reference
