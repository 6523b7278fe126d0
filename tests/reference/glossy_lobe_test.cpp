// The glossy lobe: closed forms, reciprocity, energy.
#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "reference/find_radiance_and_shadow_rays.h"
#include "reference/small_scenes.h"
#include "reference/write_emitted_and_reflective_ambient.h"
#include "sampling/ggx_lobe.h"

namespace whit::reference {
namespace {

class GlossyTest : public ::testing::Test {
 protected:
  static Surfel surfel(double alpha, double f0, const Vec3d& view) {
    Surfel s;
    s.geometricNormal = s.shadingNormal = {0, 0, 1};
    s.view = view;
    s.alpha = alpha;
    s.specular = RgbD(f0);
    return s;
  }
  static Vec3d at(double elevationCosine, double turn) {
    const double sine = std::sqrt(1 - elevationCosine * elevationCosine);
    return {sine * std::cos(turn), sine * std::sin(turn), elevationCosine};
  }
};

// Everything along the normal: D = 1 / (pi a^2), V = 1/4, F = F0.
TEST_F(GlossyTest, PeakAlongTheNormal) {
  for (const double alpha : {0.1, 0.5, 1.0}) {
    const RgbD lobe = glossyLobe(surfel(alpha, 0.04, {0, 0, 1}), {0, 0, 1});
    EXPECT_NEAR(lobe.x, 0.04 / (4 * kPi * alpha * alpha), 1e-12) << alpha;
  }
}

TEST_F(GlossyTest, IsReciprocal) {
  test::Numbers numbers(10);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d a = at(numbers.in(0.01, 1), numbers.in(0, 6)), b = at(numbers.in(0.01, 1), 0);
    const double there = glossyLobe(surfel(0.3, 0.5, a), b).x;
    EXPECT_NEAR(glossyLobe(surfel(0.3, 0.5, b), a).x, there, 1e-12 * there);
  }
}

// The share of white light from all sides that the lobe sends to the viewer, by the midpoint rule.
double albedo(const Surfel& s, Vec3d (*at)(double, double)) {
  constexpr int kRows = 400, kColumns = 400;
  double sum = 0;
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j < kColumns; ++j) {
      const double c = (i + 0.5) / kRows;
      sum += glossyLobe(s, at(c, 2 * kPi * (j + 0.5) / kColumns)).x * c;
    }
  }
  return sum * 2 * kPi / (kRows * kColumns);
}

// With F = 1 a single bounce between facets loses some energy and never gains any.
TEST_F(GlossyTest, ReflectsAtMostAllLight) {
  for (const double alpha : {0.2, 0.5, 1.0}) {
    for (const double viewCosine : {0.05, 0.5, 1.0}) {
      // 0.002: the midpoint rule on the sharpest of these lobes.
      EXPECT_LT(albedo(surfel(alpha, 1, at(viewCosine, 0)), at), 1.002)
          << alpha << ' ' << viewCosine;
    }
  }
  // The roughest, seen along the normal: integral of c / (1 + c) over [0, 1].
  EXPECT_NEAR(albedo(surfel(1, 1, {0, 0, 1}), at), 1 - std::log(2.0), 1e-6);
}

TEST_F(GlossyTest, AddsToTheDiffusePart) {
  Surfel s = surfel(0.25, 0.04, {0, 0, 1});
  s.diffuse = RgbD(0.5);
  const Light light = test::lightAt({0, 0, 2}, 4);
  const double lobe = 0.04 / (4 * kPi * 0.0625);
  EXPECT_NEAR(radianceFromLight(EffectSet::all(), s, light).radiance.x, 0.5 / kPi + lobe, 1e-12);
  const EffectSet matte = EffectSet::all().without(Effect::glossy);
  EXPECT_NEAR(radianceFromLight(matte, s, light).radiance.x, 0.5 / kPi, 1e-12);
}

// 2e-3: the largest error of the table for these views, and that of the midpoint rule.
TEST_F(GlossyTest, AlbedoIsTabulated) {
  for (const double roughness : {0.3, 0.5, 0.7, 0.9, 1.0}) {
    for (const double viewCosine : {0.2, 0.5, 0.8, 1.0}) {
      for (const double f0 : {0.04, 0.5, 1.0}) {
        const Surfel s = surfel(roughness * roughness, f0, at(viewCosine, 0));
        EXPECT_NEAR(lobeAlbedo(s.specular, 1, viewCosine, roughness).x, albedo(s, at), 2e-3)
            << roughness << ' ' << viewCosine << ' ' << f0;
      }
    }
  }
}

}  // namespace
}  // namespace whit::reference
