// Lights with a radius against closed forms, in the reference.
#include <gtest/gtest.h>

#include "penumbra.h"
#include "reference/find_radiance_and_shadow_rays.h"
#include "reference/small_scenes.h"

namespace whit::reference {
namespace {

using namespace test;

// Builds the scene of the oracle: its floor, its screen and its light.
Scene floorUnder(const Penumbra& p) {
  SceneBuilder builder = withFloor(diffuseMaterial(static_cast<float>(p.albedo)), 100);
  if (p.screen) {
    const auto y = static_cast<float>(p.edge);
    builder.add(quad({-90, y, -90}, {0, y, -90}, {0, y, 90}, {-90, y, 90}), blackMaterial());
  }

  Light light = lightAt({0, static_cast<float>(p.height), 0}, static_cast<float>(p.intensity));
  light.radius = static_cast<float>(p.radius);
  builder.description.lights = {light};
  return builder.build();
}

Settings soft(int samples) {
  Settings settings = uncut();
  settings.options.lightSamples = samples;
  return settings;
}

// The eye is below the screen and looks at the floor at x.
double seenAt(const Scene& scene, double x, const Settings& settings, RayCounts* counts = nullptr) {
  const Vec3d eye{x + 0.5, 1, 0};
  return radianceAlong(scene, eye, Vec3d{x, 0, 0} - eye, settings, counts).x;
}

// Only points of the lattice next to the edge may be wrong: a few of 4096.
constexpr double kPoints = 4096, kOff = 0.004;

TEST(SoftShadows, AnEdgeHasThePenumbraOfTheIntegral) {
  const Penumbra p;
  const Scene scene = floorUnder(p);
  const Settings settings = soft(static_cast<int>(kPoints));
  for (const double x : {-1.2, -0.45, -0.3, -0.15, 0.0, 0.1, 0.25, 0.4, 0.55, 1.2}) {
    EXPECT_NEAR(seenAt(scene, x, settings), p.radianceAt(x), kOff * p.unshadowedAt(x)) << x;
  }
}

TEST(SoftShadows, WithNothingBetweenTheSphereIsAsBrightAsItsCenter) {
  const Penumbra p{.screen = false};
  const Scene scene = floorUnder(p);
  for (const double x : {0.0, 1.0, 4.0}) {
    const double wanted = p.unshadowedAt(x);
    EXPECT_NEAR(p.radianceAt(x), wanted, 1e-3 * wanted) << "the oracle";
    EXPECT_NEAR(seenAt(scene, x, soft(256)), wanted, 2e-3 * wanted) << x;
  }
}

TEST(SoftShadows, OnePointIsTheCenterAndCostsOneRay) {
  const Penumbra p;
  const Scene scene = floorUnder(p);
  RayCounts counts;
  const double wanted = p.unshadowedAt(0.7);
  EXPECT_NEAR(seenAt(scene, 0.7, soft(1), &counts), wanted, 1e-6 * wanted);
  EXPECT_EQ(counts[RayKind::shadow], 1u);
  seenAt(scene, 0.7, soft(5), &counts);
  EXPECT_EQ(counts[RayKind::shadow], 1u + 5u);
}

TEST(SoftShadows, APointHasNone) {
  const Scene point = floorUnder(Penumbra{.radius = static_cast<double>(kPointRadius)});
  RayCounts counts;
  EXPECT_EQ(seenAt(point, 0.2, soft(16), &counts), seenAt(point, 0.2, soft(1)));
  EXPECT_EQ(counts[RayKind::shadow], 1u);
}

// From inside the sphere, no cone of directions contains it.
TEST(SoftShadows, InsideOfTheSphereTheCenterStandsForIt) {
  const Scene scene = floorUnder(Penumbra{.height = 0.5, .radius = 2, .screen = false});
  EXPECT_NEAR(seenAt(scene, 0.1, soft(4)), seenAt(scene, 0.1, soft(1)), 1e-12);
}

// Points lie on the near side of the sphere, so that their directions from the surfel are equally
// likely.
TEST(SoftShadows, PointsLieOnTheNearSideOfTheSphere) {
  Surfel surfel;
  surfel.position = {0.3, -0.2, 0.5};
  surfel.geometricNormal = surfel.shadingNormal = {0, 1, 0};
  surfel.view = {0, 1, 0};
  surfel.diffuse = RgbD(1.0);

  Light light = lightAt({1, 5, -2}, 3);
  light.radius = 1.5f;
  const Vec3d center(light.position);

  for (const float u : {0.0f, 0.3f, 0.9f, 1.0f}) {
    for (const float v : {0.0f, 0.37f, 0.8f}) {
      const LightArrival a =
          radianceFromLight(EffectSet::all(), surfel, light, {}, LightPoint{false, {u, v}});

      const Vec3d point = a.shadowRay.origin + a.shadowRay.direction;
      EXPECT_NEAR(length(point - center), 1.5, 1e-5) << u << ", " << v;
      EXPECT_LT(dot(normalized(point - center), normalized(center - surfel.position)), 1e-6);
    }
  }
}

}  // namespace
}  // namespace whit::reference
