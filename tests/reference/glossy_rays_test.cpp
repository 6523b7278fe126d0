// Samples of the glossy lobe: their distribution, the energy that they carry, and what a scene with
// rough surfaces looks like.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "core/image.h"
#include "facets.h"
#include "reference/add_impulses.h"
#include "reference/fresnel.h"
#include "reference/lobe.h"
#include "reference/sample_mean.h"
#include "reference/small_scenes.h"

namespace whit::reference {
namespace {

using namespace test;

// Level, seen from an angle with this cosine.
Surfel surfel(double alpha, double f0, double viewCosine) {
  return levelSurfel(alpha, f0, directionAt(viewCosine, 0));
}

// Pearson's test over 10 x 12 cells of equal width in the cosine and the angle of the normal.
void expectDistributedAsSeen(double alpha, double viewCosine) {
  constexpr int kRows = 10, kColumns = 12, kFine = 40, kDraws = 100000;
  const Vec3d view = directionAt(viewCosine, 0);
  std::array<double, kRows * kColumns> seen{}, expected{};

  Numbers numbers(7);
  for (int i = 0; i < kDraws; ++i) {
    const UnitPoint point = pointOf(numbers);
    const double angle = 2 * kPi * double{point.u};
    const Vec3d m = visibleNormal(view, alpha, std::cos(angle), std::sin(angle), double{point.v});
    ASSERT_GT(m.z, 0);
    const double turn = std::atan2(m.y, m.x) / (2 * kPi) + 0.5;
    ++seen[cellOf(m.z, kRows) * kColumns + cellOf(turn, kColumns)];
  }

  constexpr int kFineRows = kRows * kFine, kFineColumns = kColumns * kFine;
  for (int i = 0; i < kFineRows; ++i) {
    for (int j = 0; j < kFineColumns; ++j) {
      const double c = (i + 0.5) / kFineRows, turn = (j + 0.5) / kFineColumns - 0.5;
      const double share = visibleDensity(alpha, view, directionAt(c, 2 * kPi * turn)) * 2 * kPi;
      expected[cellAt(j / kFine, i / kFine, kColumns)] +=
          share * kDraws / (kFineRows * kFineColumns);
    }
  }

  expectDistributed(seen, expected);
}

TEST(VisibleNormals, AreDistributedAsTheyAreSeen) {
  for (const double alpha : {0.3, 0.6, 1.0}) {
    for (const double viewCosine : {0.1, 0.5, 0.999}) {
      SCOPED_TRACE(std::to_string(alpha) + " seen at " + std::to_string(viewCosine));
      expectDistributedAsSeen(alpha, viewCosine);
    }
  }
}

// weight = lobe * cosine / density of the direction, sample by sample: so what the samples bring is
// the integral of the lobe, which is reciprocal.
TEST(GlossyRays, WeighWhatTheLobeSaysOverTheirDensity) {
  Numbers numbers(8);
  for (int i = 0; i < 2000; ++i) {
    const Surfel s = surfel(numbers.in(0.05, 1), numbers.in(0.02, 1), numbers.in(0.02, 1));
    const Impulse ray = glossyImpulse(s, 0, pointOf(numbers));
    const double weight = ray.weight.x;
    if (weight == 0) continue;
    const Vec3d& l = ray.ray.direction;
    if (l.z < 0.01) continue;  // next to the horizon, rounding decides about the half vector

    const Vec3d h = normalized(s.view + l);
    const double density = visibleDensity(s.alpha, s.view, h) / (4 * dot(s.view, h));
    const double wanted = glossyLobe(s, l).x * l.z / density;
    EXPECT_NEAR(weight, wanted, 1e-9 * wanted) << s.alpha << ' ' << s.view.z << ' ' << l.z;
  }
}

double sampledAlbedo(const Surfel& s) {
  constexpr std::uint32_t kPoints = 4096;
  return meanOf(kPoints,
                [&](auto k) {
                  return glossyImpulse(s, 0, lobePoint(1, {kPoints, 0, 0}, k)).weight.x;
                })
      .value();
}

// In a white furnace: what the lobe reflects of light that comes from everywhere.
TEST(GlossyRays, BringTheAlbedoOfTheLobe) {
  for (const double alpha : {0.15, 0.4, 1.0}) {
    for (const double viewCosine : {0.1, 0.5, 0.95}) {
      // 1e-3: what 4096 points of a lattice leave of a smooth integrand, and the midpoint rule.
      EXPECT_NEAR(sampledAlbedo(surfel(alpha, 0.3, viewCosine)),
                  albedoByFacets(0.3, 1, std::sqrt(alpha), viewCosine), 1e-3)
          << alpha << ' ' << viewCosine;
    }
  }
}

// What several bounces between facets would bring is lost.
TEST(GlossyRays, GainNothing) {
  for (const double alpha : {0.002, 0.1, 0.4, 0.7, 1.0}) {
    for (const double viewCosine : {0.02, 0.3, 0.7, 1.0}) {
      const Surfel s = surfel(alpha, 1, viewCosine);
      for (std::uint32_t k = 0; k < 256; ++k) {
        const double weight = glossyImpulse(s, 0, lobePoint(2, {256, 0, 0}, k)).weight.x;
        EXPECT_LE(weight, 1 + 1e-12);
        EXPECT_GE(weight, 0);
      }
    }
  }

  // The roughest, seen along the normal: the integral of c / (1 + c) over [0, 1]; 1e-3 as above.
  EXPECT_NEAR(sampledAlbedo(surfel(1, 1, 1)), 1 - std::log(2.0), 1e-3);
  EXPECT_GT(sampledAlbedo(surfel(0.002, 1, 1)), 0.9999) << "what is nearly a mirror loses little";
}

TEST(GlossyRays, OfAVanishingLobeAreTheMirroredRay) {
  for (const double viewCosine : {0.05, 0.4, 1.0}) {
    for (const double alpha : {0.0009, 0.0011, 0.004}) {
      const Surfel s = surfel(alpha, 0.04, viewCosine);
      const Vec3d mirrored = reflect(-s.view, s.shadingNormal);
      const double schlick = 0.04 + 0.96 * schlickTerm(viewCosine);

      for (std::uint32_t k = 0; k < 64; ++k) {
        const Impulse ray = glossyImpulse(s, 0, lobePoint(3, {64, 0, 0}, k));
        const double off = length(ray.ray.direction - mirrored);
        if (alpha <= double{kSmoothAlpha}) {
          EXPECT_LT(off, 1e-12);
          EXPECT_NEAR(ray.weight.x, schlick, 1e-12);
        } else if (k < 60) {
          // All but the tail: the slope of a visible facet has the scale alpha.
          EXPECT_LT(off, 200 * alpha);
        }
      }
    }
  }

  // A roughness of 0.03 is as good as smooth, as scenes/README.md says, and 0.05 is not.
  EXPECT_EQ(glossyRays(surfel(0.03 * 0.03, 1, 1), {8, 0, 0}), 1);
  EXPECT_EQ(glossyRays(surfel(0.05 * 0.05, 1, 1), {8, 0, 0}), 8);
}

TEST(GlossyRays, StayAboveTheSurfaceThatNormalsAreBentOf) {
  Numbers numbers(9);
  for (int i = 0; i < 2000; ++i) {
    Surfel s = surfel(numbers.in(0.1, 1), 0.5, numbers.in(0.05, 1));
    s.shadingNormal = bentNormal(numbers);
    const Impulse ray = glossyImpulse(s, 0, pointOf(numbers));
    if (maxComponent(ray.weight) == 0) continue;
    EXPECT_GT(ray.ray.direction.z, 0);
    EXPECT_NEAR(length(ray.ray.direction), 1, 1e-12);
  }
}

TEST(GlossyScenes, WithoutSamplesOrWithoutTheEffectNoRayIsReflected) {
  const Scene scene = floorUnderSky(glossyMaterial(0, 0.5f, 0.5f), 2);
  RayCounts counts;
  EXPECT_GT(radianceBelow(scene, {0, 1, 0}, sampled(0), &counts).x, 0.5) << "the blurred sky";
  for (const Settings& settings :
       {without(Effect::blurredSky, sampled(0)), without(Effect::glossyReflection, sampled(8))}) {
    EXPECT_EQ(radianceBelow(scene, {0, 1, 0}, settings, &counts), RgbD());
  }
  EXPECT_EQ(counts[RayKind::reflection], 0u);
}

// Between two rough plates: N rays leave the first surface, one ray each of those that follow.
TEST(GlossyScenes, OnlyTheFirstSurfaceSendsOutSeveralRays) {
  SceneBuilder builder;
  const std::uint32_t metal = builder.add(glossyMaterial(0, 1, 0.3f));
  builder.add(floorAt(0, 1000, metal));
  builder.add(ceilingAt(2, 1000, metal));
  const Scene scene = builder.build();

  for (const int depth : {1, 3}) {
    RayCounts counts;
    radianceAlong(scene, {0, 1, 0}, steep(20), sampled(16, depth), &counts);
    const auto most = 16u * static_cast<unsigned>(depth);
    EXPECT_LE(counts[RayKind::reflection], most);
    EXPECT_GT(counts[RayKind::reflection], most * 3 / 4);
  }
}

// A material with a mirror keeps its single impulse, and a lobe next to it if it says so.
TEST(GlossyScenes, AMaterialMayKeepItsLobeForLights) {
  Material m = glossyMaterial(0, 0.5f, 0.5f);
  m.mirror = m.mirrorGrazing = Rgb(0.25f);
  m.glossyReflection = false;
  RayCounts counts;
  EXPECT_NEAR(radianceBelow(floorUnderSky(m, 2), {0, 1, 0}, sampled(8), &counts).x, 0.5, 1e-12);
  EXPECT_EQ(counts[RayKind::reflection], 1u);
}

// How many samples there are does not decide which rays are worth tracing.
TEST(GlossyScenes, TheCutoffIsAboutTheWholeLobe) {
  Settings settings = sampled(64);
  settings.options.cutoff = 0.01f;  // between the weight of the lobe and that of one of its samples
  RayCounts counts;
  radianceBelow(floorUnderSky(glossyMaterial(0, 0.04f, 0.3f)), {0, 1, 0}, settings, &counts);
  EXPECT_GT(counts[RayKind::reflection], 32u);
}

TEST(PathNumbers, TellPixelsSamplesAndBranchesApart) {
  std::set<std::uint32_t> numbers;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      for (const std::uint32_t sample : {0u, 1u, 2u, 3u}) {
        const std::uint32_t path = streamOfPixel(packedPixel(x, y), sample);
        numbers.insert(path);
        for (const std::uint32_t branch : {1u, 2u, 3u, 4u}) {
          numbers.insert(childStream(path, branch));
        }
      }
    }
  }

  // Of 32000 random numbers of 32 bits two are the same in one case of eight; never ten.
  EXPECT_GT(numbers.size(), 32000u - 10);
}

// The samples of a pixel continue one lattice where they meet the first surface.
TEST(PathNumbers, SamplesOfAPixelAreOneLattice) {
  const std::uint32_t pixel = packedPixel(5, 9);
  const LobeSampling whole = lobeSampling(0, 12, 0);

  for (std::uint32_t sample = 0; sample < 3; ++sample) {
    const LobeSampling part = lobeSampling(0, 4, sample);
    for (std::uint32_t k = 0; k < 4; ++k) {
      const UnitPoint a = lobePoint(streamOfPixel(pixel, sample), part, k);
      const UnitPoint b = lobePoint(streamOfPixel(pixel, 0), whole, 4 * sample + k);
      EXPECT_EQ(a.u, b.u);
      EXPECT_EQ(a.v, b.v);
    }
  }
  EXPECT_EQ(lobeSampling(1, 12, 2).count, 1u);
}

// 64 points: one in each of 8 x 8 cells, but for a few.
TEST(PathNumbers, PointsOfALobeAreEvenlySpread) {
  for (std::uint32_t path = 0; path < 50; ++path) {
    std::set<float> cells;
    for (std::uint32_t k = 0; k < 64; ++k) {
      const UnitPoint p = lobePoint(mixed(path), {64, 0, 0}, k);
      ASSERT_TRUE(p.u >= 0 && p.u < 1 && p.v >= 0 && p.v < 1);
      cells.insert(std::floor(p.u * 8) * 8 + std::floor(p.v * 8));
    }
    EXPECT_GE(cells.size(), 48u);  // of random points it would be 41
  }
}

// Where a sample passes the lens says nothing about the directions that its first surface draws,
// nor does one lobe about the other: each half of the one sees both halves of the other, whatever
// the shifts of the pixel's lattices.
TEST(PathNumbers, LensAndLobesAreDrawnIndependently) {
  constexpr std::uint32_t kSamples = 1024;
  constexpr double kTolerance = 0.05;  // three standard deviations of random points

  for (const int count : {1, 2, 4}) {
    for (int x = 0; x < 20; ++x) {
      std::array<std::uint32_t, 3> agree{};
      for (std::uint32_t sample = 0; sample < kSamples; ++sample) {
        const std::uint32_t path = streamOfPixel(packedPixel(x, 3), sample);
        const UnitPoint lens = saltedPoint(path, lensSampling(sample), kLensSalt, 0);
        const LobeSampling sampling = lobeSampling(0, count, sample);
        const UnitPoint glossy = whit::pointOf(kGlossyLobe, path, sampling, 0);
        const UnitPoint diffuse = whit::pointOf(kDiffuseLobe, path, sampling, 0);
        agree[0] += (lens.u < 0.5f) == (glossy.u < 0.5f);
        agree[1] += (lens.u < 0.5f) == (diffuse.u < 0.5f);
        agree[2] += (glossy.u < 0.5f) == (diffuse.u < 0.5f);
      }
      for (const std::uint32_t times : agree) {
        EXPECT_NEAR(times / double{kSamples}, 0.5, kTolerance) << count << " samples, pixel " << x;
      }
    }
  }
}

}  // namespace
}  // namespace whit::reference
