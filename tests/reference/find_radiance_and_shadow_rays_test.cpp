// Point, spot and directional lights against closed forms.
#include "reference/find_radiance_and_shadow_rays.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "reference/small_scenes.h"
#include "rounding.h"

namespace whit::reference {
namespace {

using namespace test;

// The radiance is L = kd / pi * I cos / d^2 at every pixel center.
TEST(Lights, FallOffOverAFloor) {
  const Scene scene = litFloor(diffuseMaterial(0.5f), {lightAt({0.5f, 2, -0.25f}, 30)});

  // The camera looks down with -z up. Its picture shows 7 units of the floor along z.
  const Camera camera{.eye = {0, 5, 0}, .up = {0, 0, -1}, .orthographicHeight = 7};

  Image image(9, 7);
  const RayCounts counts = render(scene, BruteForce(scene), camera, uncut(), image);
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 9; ++x) {
      const Vec3d toLight = Vec3d{0.5, 2, -0.25} - Vec3d{x - 4.0, 0, y - 3.0};
      const double d2 = dot(toLight, toLight), cosine = toLight.y / std::sqrt(d2);
      const double expected = 0.5 / kPi * 30 * cosine / d2;

      // The sum is rounded to float once.
      EXPECT_NEAR(image.at(x, y).x, expected, 1e-7 * expected) << x << ", " << y;
    }
  }

  EXPECT_EQ(counts[RayKind::primary], 63u);
  EXPECT_EQ(counts[RayKind::shadow], 63u);
  EXPECT_EQ(counts[RayKind::reflection] + counts[RayKind::refraction], 0u);
}

// Hard case H65: near a light its radius bounds the radiance; at the light the radiance is 0.
TEST(Lights, NearTheSurfaceStayFinite) {
  for (const float height : {1e-2f, 1e-6f, 1e-30f, 0.0f}) {
    Light light = lightAt({0.25f, height, 0.25f}, 1);
    light.radius = 0.1f;
    const RgbD seen = radianceBelow(litFloor(diffuseMaterial(1), {light}), {0.25, 1, 0.25},
                                    without(Effect::shadows));
    const double expected = height > 0 ? 1 / kPi / (0.1 * 0.1) : 0;
    EXPECT_NEAR(seen.x, expected, 1e-6 * expected) << height;
  }
}

// Expects a white floor to be dark from above, and no shadow ray to look for its lights.
Scene expectDark(const std::vector<Light>& lights) {
  Scene scene = litFloor(diffuseMaterial(1), lights);
  RayCounts counts;
  EXPECT_EQ(radianceBelow(scene, {0, 1, 0}, uncut(), &counts), RgbD());
  EXPECT_EQ(counts[RayKind::shadow], 0u);
  return scene;
}

TEST(Lights, BehindTheSurfaceGiveNothing) {
  const Scene scene = expectDark({lightAt({0, -2, 0}, 1)});
  EXPECT_GT(radianceAlong(scene, {0, -1, 0}, {0, 1, 0}).x, 0) << "surfaces have two sides";
}

double degrees(double x) { return x * kPi / 180; }

// Looks at a white floor 2 below the light, at the point that the light sees at `angle`.
double seenAt(const Light& light, double angle, const Settings& settings = uncut(),
              RayCounts* counts = nullptr) {
  const double x = 2 * std::tan(degrees(angle));
  return radianceBelow(litFloor(diffuseMaterial(1), {light}), {x, 1, 0}, settings, counts).x;
}

// Radiance I / pi cos / d^2 of a light of intensity 8 that shines in all directions.
double allAround(double angle) { return 2 / kPi * std::pow(std::cos(degrees(angle)), 3); }

TEST(SpotLight, IsAPointLightInsideItsInnerConeAndDarkOutsideTheOuterOne) {
  const Light light = spotOf(20, 40);
  for (const double angle : {0.0, 5.0, 19.999}) {
    EXPECT_NEAR(seenAt(light, angle), allAround(angle), kRounding) << angle;
  }
  for (const double angle : {40.001, 60.0, 80.0}) {
    RayCounts counts;
    EXPECT_EQ(seenAt(light, angle, uncut(), &counts), 0) << angle;
    EXPECT_EQ(counts[RayKind::shadow], 0u) << "nothing to look for";
  }
}

// KHR_lights_punctual squares (cos - cosOuter) / (cosInner - cosOuter).
TEST(SpotLight, FallsOffBetweenTheConesAsTheExtensionSays) {
  const Light light = spotOf(20, 40);
  for (const double angle : {21.0, 30.0, 39.0}) {
    const double outer = std::cos(degrees(40));
    const double s = (std::cos(degrees(angle)) - outer) / (std::cos(degrees(20)) - outer);
    EXPECT_NEAR(seenAt(light, angle), allAround(angle) * s * s, kRounding) << angle;
  }
}

TEST(SpotLight, WithoutTheEffectShinesAllAround) {
  EXPECT_NEAR(seenAt(spotOf(20, 40), 60, without(Effect::spotLights)), allAround(60), kRounding);
}

TEST(SpotLight, ShinesAlongItsDirectionOfAnyLength) {
  Light light = spotOf(1, 2);

  // The direction leads to the point at 30 degrees.
  light.direction = Vec3f(steep(30) * 1e-20);
  EXPECT_NEAR(seenAt(light, 30), allAround(30), 1e-6);  // the direction is rounded to float
  EXPECT_EQ(seenAt(light, 27), 0);
  EXPECT_EQ(seenAt(light, 33), 0);
}

// Hard case H67: cosines are within a few ulps of the edges, and some cones are so narrow that they
// have no width.
TEST(SpotCone, H67_fallsOffMonotonicallyBetweenItsCones) {
  for (const auto& [inner, outer] :
       {std::pair(0.0f, 90.0f), {44.999f, 45.0f}, {0.0f, 0.5f}, {89.0f, 90.0f}}) {
    const SpotCone cone = coneOf(spotOf(inner, outer));
    for (const float edge : {inner, outer}) {
      double last = 1;
      const double cosine = std::cos(degrees(static_cast<double>(edge)));
      for (int ulps = 8; ulps >= -8; --ulps) {
        const double c = std::min(cosine + ulps * 0x1p-24, 1.0);
        const double falloff = cone.falloff({std::sqrt(1 - c * c), c, 0});
        ASSERT_TRUE(falloff >= 0 && falloff <= last) << inner << " " << outer << " " << ulps;
        last = falloff;
      }
    }

    EXPECT_EQ(cone.falloff({0, -1, 0}), 0) << "behind";
    EXPECT_EQ(cone.falloff({0, 0, 0}), 0) << "nowhere";
  }
}

// The radiance is E kd / pi cos, wherever the surface lies.
TEST(DirectionalLight, IsTheSameEverywhere) {
  const Scene scene = litFloor(diffuseMaterial(0.5f), {sun({3, -4, 0}, 2)}, 1e4f);
  for (const double x : {0.0, -50.0, 9000.0}) {
    EXPECT_NEAR(radianceBelow(scene, {x, 1, 0}).x, 0.5 / kPi * 2 * 0.8, kRounding);
  }
  EXPECT_EQ(radianceBelow(scene, {0, 1, 0}, without(Effect::directionalLights)), RgbD());
}

// Hard case H67: light arrives along the surface, or from behind it.
TEST(DirectionalLight, H67_givesNothingFromTheHorizonOrBelow) {
  expectDark({sun({1, 0, 0}, 1), sun({0, 1, 0}, 1), sun({1, 1e-30f, 0}, 1)});
}

TEST(DirectionalLight, HasAHighlight) {
  Surfel s;
  s.view = normalized(Vec3d{-1, 1, 0});
  s.geometricNormal = s.shadingNormal = {0, 1, 0};
  s.specular = RgbD(0.5);
  s.alpha = 0.25;

  const LightArrival mirrored = radianceFromLight(EffectSet::all(), s, sun({-1, -1, 0}, 3));
  const Vec3d l = normalized(Vec3d{1, 1, 0});
  EXPECT_NEAR(mirrored.radiance.x, glossyLobe(s, l).x * 3 * std::sqrt(0.5), kRounding);
  EXPECT_NEAR(dot(mirrored.shadowRay.direction, l), 1, kRounding);
  EXPECT_TRUE(std::isinf(mirrored.tFar));
}

}  // namespace
}  // namespace whit::reference
