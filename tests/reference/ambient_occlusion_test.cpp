// Ambient occlusion against closed forms. The estimates are within three standard errors, which are
// measured over independent paths.
#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "reference/find_radiance_and_shadow_rays.h"
#include "reference/sample_mean.h"
#include "reference/small_scenes.h"

namespace whit::reference {
namespace {

using namespace test;

constexpr std::uint32_t kPaths = 1000, kSamples = 16;

Settings occluded(int samples) {
  Settings settings = uncut();
  settings.options.ambientSamples = samples;
  return settings;
}

// The floor y = 0 has albedo 1 and the ambient light is 1, so that its radiance is the share of
// open directions.
SceneBuilder floorInAmbientLight(float radius) {
  SceneBuilder builder = withFloor(diffuseMaterial(1), 1000);
  builder.description.ambient = {Rgb(1), Rgb(1), 0, radius};
  return builder;
}

// Estimates the share of ambient light that reaches the floor's point at `x`.
SampleMean openShareAt(const Scene& scene, double x) {
  const BruteForce bruteForce(scene);
  const Tracer tracer(scene, bruteForce, occluded(kSamples));
  RayCounts counts;
  const SampleMean mean = meanOf(kPaths, [&](auto path) {
    return tracer.traceImpulse({{x, 1e-3, 0}, {0, -1, 0}}, 0, 1, 0, counts, {mixed(path), 0}).x;
  });

  EXPECT_EQ(counts[RayKind::occlusion], kPaths * kSamples);
  EXPECT_EQ(counts[RayKind::shadow], 0u);
  return mean;
}

// A direction is open if its horizontal part towards the wall is below distance / radius. Weighted
// by the cosine, these directions are the unit disc without a segment.
TEST(AmbientOcclusion, BesideAWallIsASegmentOfTheDisc) {
  constexpr double kRadius = 2;
  SceneBuilder builder = floorInAmbientLight(kRadius);
  builder.add(quad({0, 0, -1000}, {0, 0, 1000}, {0, 1000, 1000}, {0, 1000, -1000}, 0));
  const Scene scene = builder.build();

  for (const double x : {0.01, 0.5, 1.0, 1.7}) {
    const SampleMean mean = openShareAt(scene, x);
    const double c = x / kRadius;
    const double wanted = 1 - (std::acos(c) - c * std::sqrt(1 - c * c)) / kPi;
    EXPECT_NEAR(mean.value(), wanted, 3 * mean.error()) << x;
    EXPECT_LT(mean.error(), 0.005);
  }

  EXPECT_EQ(openShareAt(scene, 2.01).value(), 1) << "further away than the radius";
}

// Rays reach the ceiling if they are near enough to the normal: cosine^2 > (height / radius)^2.
TEST(AmbientOcclusion, BelowACeilingIsTheSquareOfTheRatio) {
  SceneBuilder builder = floorInAmbientLight(2);
  builder.add(ceilingAt(1.2f, 1000, 0));
  const SampleMean mean = openShareAt(builder.build(), 0);
  EXPECT_NEAR(mean.value(), 0.36, 3 * mean.error());
}

// Everything within the radius occludes, and nothing else does.
TEST(AmbientOcclusion, InsideABoxDependsOnItsSizeAlone) {
  for (const auto& [radius, wanted] : {std::pair{0.99f, 1.0}, std::pair{3.0f, 0.0}}) {
    SceneBuilder builder = floorInAmbientLight(radius);
    builder.add(box({-1, -1, -1}, {1, 1, 1}, 0));
    EXPECT_EQ(openShareAt(builder.build(), 0).value(), wanted) << radius;
  }
}

TEST(AmbientOcclusion, PassesWhatCastsNoShadow) {
  SceneBuilder builder = floorInAmbientLight(10);
  Material clear = glassMaterial(1.5f);
  clear.castsShadow = false;
  builder.add(ceilingAt(1, 1000), clear);
  EXPECT_EQ(openShareAt(builder.build(), 0).value(), 1);
}

TEST(AmbientOcclusion, IsTheConstantWithoutRaysOrRadiusOrTheEffect) {
  struct Absent {
    float radius;
    Settings settings;
  };
  for (const auto& [radius, settings] : {Absent{0, occluded(4)},
                                         {2, occluded(0)},
                                         {2, without(Effect::ambientOcclusion, occluded(4))}}) {
    SceneBuilder builder = floorInAmbientLight(radius);
    builder.add(ceilingAt(1, 1000, 0));
    RayCounts counts;
    EXPECT_EQ(radianceBelow(builder.build(), {0, 0.5, 0}, settings, &counts), RgbD(1.0));
    EXPECT_EQ(counts[RayKind::occlusion], 0u);
  }
}

// With a bent normal, directions below the surface are occluded by the surface itself.
TEST(AmbientOcclusion, OfASurfaceByItself) {
  Scene scene;
  scene.materials.resize(1);
  scene.ambient = {Rgb(1), Rgb(1), 0, 1};

  Surfel s;
  s.diffuse = RgbD(1.0);
  s.geometricNormal = s.view = {0, 1, 0};
  s.shadingNormal = normalized(Vec3d(1, 1, 0));

  const SampleMean mean = meanOf(1024, [&](auto k) {
    const LightArrival a =
        ambientArrival(scene, allBut(Effect::indirect), s, {}, lobePoint(7, {1024, 0, 0}, k));
    if (a.radiance.x > 0) {
      EXPECT_GT(a.shadowRay.direction.y, 0);
      EXPECT_EQ(a.tFar, 1);
    }
    return a.radiance.x;
  });

  // Half of the lobe's disc is open, and the other half is foreshortened by the angle between the
  // normals.
  EXPECT_NEAR(mean.value(), 0.5 + 0.5 * std::cos(kPi / 4), 3 * mean.error());
}

}  // namespace
}  // namespace whit::reference
