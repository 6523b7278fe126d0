// Spot and directional lights against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "reference/shading.h"
#include "reference/small_scenes.h"
#include "rounding.h"

namespace whit::reference {
namespace {

using test::lightAt;
using test::radianceAlong;
using test::SceneBuilder;

Light spotAt(const Vec3f& position, float intensity, float inner, float outer) {
  Light light = lightAt(position, intensity);
  light.kind = Light::Kind::spot;
  light.innerConeAngle = inner;
  light.outerConeAngle = outer;
  return light;
}

Light sun(const Vec3f& direction, float irradiance) {
  Light light;
  light.kind = Light::Kind::directional;
  light.direction = direction;
  light.intensity = Rgb(irradiance);
  return light;
}

double degrees(double x) { return x * kPi / 180; }

// What a white floor 2 below the light shows at the point seen from the light at `angle`.
class SpotLight : public ::testing::Test {
 protected:
  double seenAt(const Light& light, double angle, EffectSet effects = EffectSet::all(),
                RayCounts* counts = nullptr) {
    SceneBuilder builder;
    builder.add(test::floorAt(0, 100, builder.add(test::diffuseMaterial(1))));
    builder.description.lights = {light};
    Settings settings = test::uncut();
    settings.effects = effects;
    const double x = 2 * std::tan(degrees(angle));
    return radianceAlong(builder.build(), {x, 1, 0}, {0, -1, 0}, settings, counts).x;
  }
  // I / pi cos / d^2 of a light that shines all around.
  static double allAround(double angle) {
    const double cosine = std::cos(degrees(angle)), d = 2 / cosine;
    return 8 / kPi * cosine / (d * d);
  }
};

TEST_F(SpotLight, IsAPointLightInsideItsInnerConeAndDarkOutsideTheOuterOne) {
  const Light light = spotAt({0, 2, 0}, 8, 20, 40);
  for (const double angle : {0.0, 5.0, 19.999}) {
    EXPECT_NEAR(seenAt(light, angle), allAround(angle), kRounding) << angle;
  }
  for (const double angle : {40.001, 60.0, 80.0}) {
    RayCounts counts;
    EXPECT_EQ(seenAt(light, angle, EffectSet::all(), &counts), 0) << angle;
    EXPECT_EQ(counts.shadow, 0u) << "nothing to look for";
  }
}

// KHR_lights_punctual: the square of (cos - cosOuter) / (cosInner - cosOuter).
TEST_F(SpotLight, FallsOffBetweenTheConesAsTheExtensionSays) {
  const Light light = spotAt({0, 2, 0}, 8, 20, 40);
  for (const double angle : {21.0, 30.0, 39.0}) {
    const double s = (std::cos(degrees(angle)) - std::cos(degrees(40))) /
                     (std::cos(degrees(20)) - std::cos(degrees(40)));
    EXPECT_NEAR(seenAt(light, angle), allAround(angle) * s * s, kRounding) << angle;
  }
}

TEST_F(SpotLight, WithoutTheEffectShinesAllAround) {
  const EffectSet effects = EffectSet::all().without(Effect::spotLights);
  EXPECT_NEAR(seenAt(spotAt({0, 2, 0}, 8, 20, 40), 60, effects), allAround(60), kRounding);
}

TEST_F(SpotLight, ShinesAlongItsDirectionOfAnyLength) {
  Light light = spotAt({0, 2, 0}, 8, 1, 2);
  // Towards the point at 30 degrees.
  light.direction = Vec3f(Vec3d{std::sin(degrees(30)), -std::cos(degrees(30)), 0} * 1e-20);
  EXPECT_NEAR(seenAt(light, 30), allAround(30), 1e-6);  // the direction is rounded to float
  EXPECT_EQ(seenAt(light, 27), 0);
  EXPECT_EQ(seenAt(light, 33), 0);
}

// Hard case H67: cosines within a few ulps of the edges, and cones so narrow that they have no
// width.
TEST(SpotCone, H67_fallsOffMonotonicallyBetweenItsCones) {
  for (const auto& [inner, outer] : {std::pair(0.0f, 90.0f), std::pair(44.999f, 45.0f),
                                     std::pair(0.0f, 0.5f), std::pair(89.0f, 90.0f)}) {
    const SpotCone cone = coneOf(spotAt({0, 0, 0}, 1, inner, outer));
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

// E kd / pi cos, wherever the surface lies.
TEST(DirectionalLight, IsTheSameEverywhere) {
  SceneBuilder builder;
  builder.add(test::floorAt(0, 1e4f, builder.add(test::diffuseMaterial(0.5f))));
  builder.description.lights = {sun({3, -4, 0}, 2)};
  const Scene scene = builder.build();
  for (const double x : {0.0, -50.0, 9000.0}) {
    EXPECT_NEAR(radianceAlong(scene, {x, 1, 0}, {0, -1, 0}).x, 0.5 / kPi * 2 * 0.8, kRounding);
  }
  Settings settings = test::uncut();
  settings.effects = EffectSet::all().without(Effect::directionalLights);
  EXPECT_EQ(radianceAlong(scene, {0, 1, 0}, {0, -1, 0}, settings), RgbD());
}

// However far away what stands in the way is; behind the surface nothing does.
TEST(DirectionalLight, ShadowsReachToTheEndOfTheScene) {
  for (const float height : {0.01f, 10.0f, 1e6f}) {
    SceneBuilder builder;
    const auto gray = builder.add(test::diffuseMaterial(1));
    builder.add(test::floorAt(0, 10, gray));
    builder.add(test::floorAt(-5, 10, gray));
    // The light comes down from +x at 45 degrees: what hangs at `height` darkens what lies as far
    // to the left.
    const float x = height;
    builder.add(test::quad({x - 1, height, 1}, {x + 1, height, 1}, {x + 1, height, -1},
                           {x - 1, height, -1}, gray));
    builder.description.lights = {sun({-1, -1, 0}, 1)};
    const Scene scene = builder.build();
    // A ray from just above the floor; the screen is beyond.
    EXPECT_EQ(radianceAlong(scene, {0, 0.005, 0}, {0, -1, 0}).x, 0) << height;
    EXPECT_NEAR(radianceAlong(scene, {5, 0.005, 0}, {0, -1, 0}).x, 1 / kPi * std::sqrt(0.5), 1e-9);
  }
}

// Hard case H67: at a right angle to the surface, and from behind it.
TEST(DirectionalLight, H67_givesNothingFromTheHorizonOrBelow) {
  SceneBuilder builder;
  builder.add(test::floorAt(0, 1, builder.add(test::diffuseMaterial(1))));
  builder.description.lights = {sun({1, 0, 0}, 1), sun({0, 1, 0}, 1), sun({1, 1e-30f, 0}, 1)};
  RayCounts counts;
  EXPECT_EQ(radianceAlong(builder.build(), {0, 1, 0}, {0, -1, 0}, test::uncut(), &counts), RgbD());
  EXPECT_EQ(counts.shadow, 0u);
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
