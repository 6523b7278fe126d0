// Light from one diffuse surface to the next, against closed forms. Estimates are within three
// standard errors, which are measured over independent paths.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "pi.h"
#include "reference/add_impulses.h"
#include "reference/lobe.h"
#include "reference/sample_mean.h"
#include "reference/small_scenes.h"
#include "sampling/random_streams.h"
#include "shapes/generated.h"

namespace whit::reference {
namespace {

using namespace test;

Settings indirect(int samples, int depth = 8) {
  Settings settings = uncut(depth);
  settings.options.indirect = samples;
  return settings;
}

// Traces rays to surfaces, each on a path of its own number.
class Looking {
 public:
  Looking(const Scene& scene, const Settings& settings)
      : bruteForce_(scene), tracer_(scene, bruteForce_, settings) {}

  RgbD along(const Vec3d& origin, const Vec3d& direction, std::uint32_t path) {
    return tracer_.traceImpulse({origin, normalized(direction)}, 0, 1.0, 0, counts,
                                {mixed(path), 0});
  }

  // Looks down at a point from a small height.
  double onto(const Vec3d& point, double height, std::uint32_t path) {
    return along(point + Vec3d(0, height, 0), {0, -1, 0}, path).x;
  }

  RayCounts counts;

 private:
  BruteForce bruteForce_;
  Tracer tracer_;
};

// Pearson's test over cells of equal probability: the square of the sine and the azimuth are
// uniformly distributed.
TEST(CosineDirections, AreDistributedByTheCosine) {
  constexpr int kRows = 12, kColumns = 16, kDraws = 200000;
  Numbers numbers(3);
  for (const Vec3d& n : {Vec3d(0, 0, 1), Vec3d(0, -1, 0), Vec3d(1, 0, 0),
                         normalized(Vec3d(1, 2, -3)), normalized(Vec3d(-0.56, 0.8, 0.1))}) {
    const Vec3d across = normalized(cross(n, normalized(Vec3d(0.3, -0.8, 0.5)))),
                along = cross(n, across);

    std::vector<double> seen(kRows * kColumns);
    for (int i = 0; i < kDraws; ++i) {
      const Vec3d d = cosineDirection(n, pointOf(numbers));
      EXPECT_NEAR(length(d), 1, 1e-12);
      ASSERT_GT(dot(d, n), 0);

      const double c = dot(d, n), turn = std::atan2(dot(d, along), dot(d, across)) / (2 * kPi);
      ++seen[cellOf(1 - c * c, kRows) * kColumns + cellOf(turn + 0.5, kColumns)];
    }

    expectDistributed(seen, std::vector<double>(seen.size(), double{kDraws} / (kRows * kColumns)));
  }
}

TEST(CosineDirections, NeverLieInTheSurface) {
  for (const UnitPoint& at : {UnitPoint{0, 0}, UnitPoint{0.25f, 1 - 0x1p-24f}}) {
    EXPECT_GE(cosineDirection({0, 0, 1}, at).z, 0x1p-12 - 1e-12);
  }
}

TEST(IndirectRays, WeighTheAlbedoAndStayAboveTheSurface) {
  Numbers numbers(4);
  for (int i = 0; i < 2000; ++i) {
    Surfel s;
    s.geometricNormal = {0, 0, 1};
    s.shadingNormal = bentNormal(numbers);
    s.view = bentNormal(numbers);
    s.diffuse = {0.2, 0.5, 0.8};
    s.coverage = 0.5;

    const Impulse ray = indirectImpulse(s, 7, pointOf(numbers));
    EXPECT_EQ(ray.weight, s.diffuse * 0.5);
    EXPECT_EQ(ray.media, 7u);
    EXPECT_GT(ray.ray.direction.z, 0);
    EXPECT_NEAR(length(ray.ray.direction), 1, 1e-12);
  }
}

Scene roomOf(float albedo) {
  Material wall = diffuseMaterial(albedo);
  wall.emission = Rgb(1);
  return sceneOf(exactSphere(), wall);
}

// The geometric series up to the depth.
double seriesOf(double albedo, int depth) {
  return (1 - std::pow(albedo, depth + 1)) / (1 - albedo);
}

// In a closed room of one emission and albedo all paths have the same radiance.
TEST(IndirectFurnace, IsTheGeometricSeries) {
  for (const float albedo : {0.5f, 0.9f}) {
    const Scene scene = roomOf(albedo);
    for (const int depth : {0, 1, 5, 64}) {
      Looking looking(scene, indirect(3, depth));
      const double wanted = seriesOf(double{albedo}, depth);
      for (const std::uint32_t path : {0u, 1u, 2u, 3u}) {
        const double seen = looking.along({0.2, -0.1, 0.3}, {1, 2, -1}, path).x;
        EXPECT_NEAR(seen, wanted, 1e-12 * wanted) << albedo << ' ' << depth;
      }
    }
  }
}

// Russian roulette sums the whole series, although a path has only about a dozen rays.
TEST(IndirectFurnace, IsTheGeometricSeriesUnderRouletteToo) {
  for (const float albedo : {0.5f, 0.9f}) {
    const Scene scene = roomOf(albedo);
    for (const float roulette : {0.1f, 0.5f, 1.0f}) {
      Settings settings = indirect(1, kDepthLimit);
      settings.options.roulette = roulette;
      settings.options.cutoff = 0.3f;  // ignored, since roulette replaces the cutoff

      Looking looking(scene, settings);
      const SampleMean mean = meanOf(4000, [&](auto path) {
        return looking.along({0.2, -0.1, 0.3}, {1, 2, -1}, path).x;
      });

      // The paths end at the deepest impulse.
      EXPECT_NEAR(mean.value(), seriesOf(double{albedo}, kDepthLimit), 3 * mean.error()) << albedo;
      EXPECT_GT(mean.error(), 0);
      EXPECT_LT(looking.counts[RayKind::indirect], 4000u * 40);
    }
  }
}

// Mirror, transmission and diffuse color share the light of a surface. In a room of radiance 1 no
// path returns more than 1, not even inside the ball, where an excess would grow at every bounce.
TEST(IndirectFurnace, MixturesOfAllKindsMakeNoLight) {
  Numbers numbers(17);
  const auto color = [&] {
    return Rgb(numbers.in(0, 1) < 0.2
                   ? Vec3d(1.0)
                   : Vec3d{numbers.in(0, 1), numbers.in(0, 1), numbers.in(0, 1)});
  };

  for (int i = 0; i < 500; ++i) {
    Material m;
    m.diffuse = color();
    if (numbers.in(0, 1) < 0.5) m.mirror = m.mirrorGrazing = color();
    if (numbers.in(0, 1) < 0.3) m.mirrorGrazing = Rgb(1.0f);
    if (numbers.in(0, 1) < 0.7) m.transmission = color();
    m.ior = static_cast<float>(numbers.in(0.6, 2.5));
    m.thin = numbers.in(0, 1) < 0.2;

    Settings settings = indirect(1, 12);
    settings.options.cutoff = 1e-3f;
    const Scene scene = sceneOf(exactSphere(), m, 1);
    Looking looking(scene, settings);

    for (std::uint32_t path = 0; path < 8; ++path) {
      const Vec3d eye = numbers.direction() * 4.0;
      const Vec3d to = numbers.direction() * numbers.in(0, 1);
      EXPECT_LE(maxComponent(looking.along(eye, to - eye, path)), 1 + 1e-9) << i << ' ' << path;
    }
  }
}

// Opaque and thin surfaces that absorb nothing return all of the light. (Within a solid, the
// diffuse color also scatters light into directions that are reflected totally for ever.)
TEST(IndirectFurnace, MixturesThatAbsorbNothingKeepAllLight) {
  for (const float transmission : {0.0f, 0.1f, 0.5f, 0.9f, 1.0f}) {
    for (const float mirror : {0.0f, 0.3f, 1.0f}) {
      Material m;
      m.diffuse = Rgb(1.0f);
      m.transmission = Rgb(transmission);
      m.thin = true;
      m.mirror = m.mirrorGrazing = Rgb(mirror);

      const Scene scene = floorUnderSky(m, 1, 2);
      Looking looking(scene, indirect(1));

      for (const std::uint32_t path : {0u, 1u, 2u, 3u}) {
        const double seen = looking.along({3, 0.8, 0.2}, {-3, -0.8, 0.1}, path).x;
        EXPECT_NEAR(seen, 1, 1e-6) << transmission << ' ' << mirror;
      }
    }
  }
}

TEST(IndirectScenes, AFloorUnderAUniformSkyShowsItsAlbedo) {
  const Scene scene = floorUnderSky(diffuseMaterial(0.5f), 2);
  Looking looking(scene, indirect(16));
  for (const double degrees : {0.0, 10.0, 60.0}) {
    EXPECT_NEAR(looking.along({0, 1, 0}, steep(degrees), 1).x, 1, 1e-12);
  }
  EXPECT_EQ(looking.counts[RayKind::indirect], 3u * 16);
}

// Makes a disc of triangles, with an error of 4e-4 in its area.
Mesh disc(double y, double radius) {
  Mesh mesh = meshOf("disc", joined("'segments': 128, 'radius': ", radius));
  transform(mesh, Affine::translation({0, y, 0}));
  return mesh;
}

// Howell, "A catalog of radiation heat transfer configuration factors", C-41.
double factorOfDiscs(double r1, double r2, double distance) {
  const double a = r1 / distance, b = r2 / distance, s = 1 + (1 + b * b) / (a * a);
  return 0.5 * (s - std::sqrt(s * s - 4 * (r2 / r1) * (r2 / r1)));
}

TEST(FormFactors, OfTwoFacingDiscs) {
  for (const auto& [r1, r2, distance] :
       {std::array{1.0, 1.0, 1.0}, std::array{0.5, 2.0, 1.0}, std::array{2.0, 0.5, 0.7}}) {
    SceneBuilder builder;
    builder.add(disc(0, r1), diffuseMaterial(1));
    builder.add(disc(distance, r2), emittingMaterial(1));
    const Scene scene = builder.build();

    Looking looking(scene, indirect(64, 1));
    Numbers numbers(5);
    const double edge = 0.999 * r1;
    const SampleMean mean = meanOf(1000, [&](auto path) {
      const double r = edge * std::sqrt(numbers.in(0, 1)), turn = numbers.in(0, 2 * kPi);
      return looking.onto({r * std::cos(turn), 0, r * std::sin(turn)}, 1e-3, path);
    });

    // The discs are polygons, and the border of the first is not looked at: both change the factor
    // by 1e-3.
    const double wanted = factorOfDiscs(r1, r2, distance);
    EXPECT_NEAR(mean.value(), wanted, 3 * mean.error() + 1e-3 * wanted) << r1 << ' ' << r2;
    EXPECT_LT(mean.error(), 0.05 * wanted);
  }
}

// Howell, C-14: the factor of rectangles of height `tall` and depth `deep` that share an edge of
// length `wide`.
double factorOfPlates(double wide, double deep, double tall) {
  const double h = tall / wide, w = deep / wide, h2 = h * h, w2 = w * w, both = h2 + w2;
  const double logs = (1 + w2) * (1 + h2) / (1 + both) *
                      std::pow(w2 * (1 + both) / ((1 + w2) * both), w2) *
                      std::pow(h2 * (1 + both) / ((1 + h2) * both), h2);

  return (w * std::atan(1 / w) + h * std::atan(1 / h) -
          std::sqrt(both) * std::atan(1 / std::sqrt(both)) + 0.25 * std::log(logs)) /
         (kPi * w);
}

TEST(FormFactors, OfPerpendicularPlates) {
  for (const auto& size : {std::array{1.0f, 1.0f, 1.0f}, {2.0f, 1.0f, 0.5f}, {1.0f, 0.4f, 3.0f}}) {
    const float w = size[0], d = size[1], t = size[2];
    SceneBuilder builder;
    builder.add(quad({0, 0, w}, {d, 0, w}, {d, 0, 0}, {0, 0, 0}), diffuseMaterial(1));
    builder.add(quad({0, 0, 0}, {0, t, 0}, {0, t, w}, {0, 0, w}), emittingMaterial(1));
    const Scene scene = builder.build();

    Looking looking(scene, indirect(16, 1));
    Numbers numbers(6);
    const SampleMean mean = meanOf(2000, [&](auto path) {
      const Vec3d at{numbers.in(0, d), 0, numbers.in(0, w)};
      // The eye is just above the plate, so that the other plate does not hide it.
      return looking.onto(at, 1e-4 * t, path);
    });

    EXPECT_NEAR(mean.value(), factorOfPlates(w, d, t), 3 * mean.error()) << w << ' ' << d;
    EXPECT_LT(mean.error(), 0.02);
  }
}

// What glass does to the light of a plate is what it does to that of an eye in the plate's place,
// which oracle/ compares. So caustics are as bright as they should be.
TEST(IndirectScenes, APlateBelowABallLensGetsWhatAnEyeThereSees) {
  SceneBuilder builder = withFloor(diffuseMaterial(1), 1e-3f);
  builder.add(exactSphere(0, Affine::translation(Vec3d(0, 1.4, 0))), glassMaterial(1.5f));
  whiteAbove(builder);
  const Scene scene = builder.build();

  constexpr std::uint32_t kRays = 64;
  Looking looking(scene, indirect(kRays));
  for (std::uint32_t path = 0; path < 8; ++path) {
    double wanted = 0;
    for (std::uint32_t k = 0; k < kRays; ++k) {
      const UnitPoint at = pointOf(kDiffuseLobe, mixed(path), lobeSampling(0, kRays, 0), k);
      const Vec3d direction = cosineDirection({0, 1, 0}, at);
      wanted += radianceAlong(scene, {0, 1e-6, 0}, direction, uncut(7)).x / kRays;
    }
    EXPECT_NEAR(looking.along({0, 0.1, 0}, {0, -1, 0}, path).x, wanted, 1e-5) << path;
  }
}

TEST(IndirectScenes, AmbientLightGoesWhereTheSceneIsReflected) {
  SceneBuilder builder = withFloor(diffuseMaterial(0.5f), 1000);
  Material kept = diffuseMaterial(0.5f);
  kept.diffuseReflection = false;
  builder.add(floorAt(1, 0.5f), kept);
  lightEvenly(builder, 1);
  const Scene scene = builder.build();

  const auto seen = [&](int samples, double x) {
    Looking looking(scene, indirect(samples));
    return looking.along({x, 2, 0}, {0, -1, 0}, 1).x;
  };

  EXPECT_NEAR(seen(0, 5), 0.5, 1e-12);
  EXPECT_EQ(seen(4, 5), 0);
  EXPECT_NEAR(seen(4, 0.1), 0.5, 1e-12) << "a surface that does not reflect the scene keeps it";
}

TEST(IndirectScenes, OnlyTheFirstSurfaceSendsOutSeveralRays) {
  const Scene scene = sceneOf(box({-1, -1, -1}, {1, 1, 1}), diffuseMaterial(1));
  for (const int depth : {1, 3}) {
    Looking looking(scene, indirect(16, depth));
    looking.along({0, 0, 0}, {1, 2, 3}, 1);
    EXPECT_EQ(looking.counts[RayKind::indirect], 16u * static_cast<unsigned>(depth));
  }
}

// Point lights are found by shadow rays alone and count once: the ceiling shows the light that the
// floor reflects.
TEST(IndirectScenes, LightOfALampComesFromWhatItShinesOn) {
  SceneBuilder builder = withFloor(diffuseMaterial(0.5f), 1000);
  builder.add(ceilingAt(2, 1000), diffuseMaterial(1));
  builder.description.lights = {sun({0, -1, 0}, static_cast<float>(kPi))};
  builder.description.materials[1].castsShadow = false;
  const Scene scene = builder.build();

  // The floor is lit by pi, so that its radiance is its albedo. The ceiling sees nothing but the
  // floor, and the floor nothing but the ceiling.
  for (const int depth : {1, 2, 3, 4}) {
    Looking looking(scene, indirect(4, depth));
    const double seen = looking.along({0, 1, 0}, {0.1, 1, 0}, 1).x;

    // Every second bounce is one at the lit floor, which adds half of what the bounce before added.
    EXPECT_NEAR(seen, seriesOf(0.5, (depth - 1) / 2) / 2, 2e-3)
        << depth << ": but for paths that end beyond the edges";
  }
}

// Behind the first hit one of two lobes is followed for both, so that in the mean each counts once.
TEST(LobeChoice, CountsEachLobeOnceInTheMean) {
  Material m = diffuseMaterial(0.5f);
  m.specular = Rgb(0.3f);
  Surfel s = levelSurfel(0.2, 0.3, {0, 0, 1});
  s.diffuse = {0.5, 0.2, 0.1};

  for (const double share : {0.02, 0.3, 0.9}) {
    s.lobe = {0.1, share, 0.2};
    for (const Lobe& lobe : {kGlossyLobe, kDiffuseLobe}) {
      const SampleMean mean = meanOf(100000, [&](auto path) {
        return factorOfLobe(lobe, m, EffectSet::all(), s, 1, mixed(path));
      });
      EXPECT_NEAR(mean.value(), 1, 3 * mean.error()) << share;
      EXPECT_LT(mean.error(), 0.01);
    }
  }
}

// An impulse below the threshold of roulette is traced with the probability of its contribution,
// and then weighs as much more.
TEST(Roulette, KeepsTheMeanAndTracesLess) {
  RenderOptions options;
  options.roulette = 0.4f;
  options.cutoff = 1;

  for (const double contribution : {0.001, 0.1, 0.39, 0.4, 0.9}) {
    double kept = 0, traced = 0;
    constexpr std::uint32_t kPaths = 200000;

    for (std::uint32_t path = 0; path < kPaths; ++path) {
      if (!survives(options, contribution, childStream(mixed(path), 3))) continue;
      ++traced;
      kept += growthOfSurvivors(options, contribution);
    }

    const double p = std::min(1.0, contribution / double{options.roulette});
    EXPECT_NEAR(kept / kPaths, 1, 3 * std::sqrt((1 - p) / (p * kPaths)) + 1e-12) << contribution;
    EXPECT_NEAR(traced / kPaths, p, 3 * std::sqrt(p * (1 - p) / kPaths) + 1e-12);
  }
}

TEST(Roulette, OffLeavesItToTheCutoff) {
  RenderOptions options;
  options.cutoff = 0.01f;
  EXPECT_TRUE(survives(options, 0.02, 1));
  EXPECT_FALSE(survives(options, 0.005, 1));
  EXPECT_FALSE(survives(options, std::nan(""), 1));
  EXPECT_EQ(growthOfSurvivors(options, 0.02), 1);

  options.roulette = 0.1f;
  EXPECT_FALSE(survives(options, std::nan(""), 1));
}

}  // namespace
}  // namespace whit::reference
