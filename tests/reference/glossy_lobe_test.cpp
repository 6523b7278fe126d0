// The glossy lobe: closed forms and reciprocity.
#include <gtest/gtest.h>

#include "reference/lobe.h"
#include "reference/small_scenes.h"

namespace whit::reference {
namespace {

using namespace test;

// Everything along the normal: D = 1 / (pi a^2), V = 1/4, F = F0.
TEST(GlossyLobe, PeakAlongTheNormal) {
  for (const double alpha : {0.1, 0.5, 1.0}) {
    const RgbD lobe = glossyLobe(levelSurfel(alpha, 0.04, {0, 0, 1}), {0, 0, 1});
    EXPECT_NEAR(lobe.x, 0.04 / (4 * kPi * alpha * alpha), 1e-12) << alpha;
  }
}

TEST(GlossyLobe, IsReciprocal) {
  Numbers numbers(10);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d a = directionAt(numbers.in(0.01, 1), numbers.in(0, 6)),
                b = directionAt(numbers.in(0.01, 1), 0);
    const double there = glossyLobe(levelSurfel(0.3, 0.5, a), b).x;
    EXPECT_NEAR(glossyLobe(levelSurfel(0.3, 0.5, b), a).x, there, 1e-12 * there);
  }
}

TEST(GlossyLobe, AddsToTheDiffusePart) {
  Surfel s = levelSurfel(0.25, 0.04, {0, 0, 1});
  s.diffuse = RgbD(0.5);
  const Light light = lightAt({0, 0, 2}, 4);
  const double lobe = 0.04 / (4 * kPi * 0.0625);

  EXPECT_NEAR(radianceFromLight(EffectSet::all(), s, light).radiance.x, 0.5 / kPi + lobe, 1e-12);
  const EffectSet matte = allBut(Effect::glossy);
  EXPECT_NEAR(radianceFromLight(matte, s, light).radiance.x, 0.5 / kPi, 1e-12);
}

}  // namespace
}  // namespace whit::reference
