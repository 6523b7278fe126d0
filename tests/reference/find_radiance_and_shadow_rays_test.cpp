// Point, spot and directional lights against closed forms.
#include "reference/find_radiance_and_shadow_rays.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "reference/small_chunk.h"
#include "reference/small_scenes.h"
#include "rounding.h"

namespace whit::reference {
namespace {

using test::lightAt;
using test::radianceAlong;
using test::SceneBuilder;
using test::sun;

// Returns the point on the floor y = 0 at pixel (x, y) of a w x h image. The camera is 5 above the
// floor and looks down with -z up.
Vec3d pointOnFloor(double x, double y, int w, int h, double fovDegrees) {
  const double half = 5 * std::tan(fovDegrees * kPi / 360);
  return {(x + 0.5 - w / 2.0) / (h / 2.0) * half, 0, (y + 0.5 - h / 2.0) / (h / 2.0) * half};
}

// The radiance is L = kd / pi * I cos / d^2 at every pixel center.
TEST(Lights, FallOffOverAFloor) {
  SceneBuilder builder;
  builder.add(test::floorAt(0, 100, builder.add(test::diffuseMaterial(0.5f))));
  builder.description.lights = {lightAt({0.5f, 2, -0.25f}, 30)};
  const Scene scene = builder.build();

  Camera camera;
  camera.eye = {0, 5, 0};
  camera.at = {0, 0, 0};
  camera.up = {0, 0, -1};
  camera.fov = 60;

  Image image(9, 7);
  const RayCounts counts = render(scene, BruteForce(scene), camera, test::uncut(), image);
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 9; ++x) {
      const Vec3d toLight = Vec3d{0.5, 2, -0.25} - pointOnFloor(x, y, 9, 7, 60);
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
    SceneBuilder builder;
    builder.add(test::floorAt(0, 1, builder.add(test::diffuseMaterial(1))));
    Light light = lightAt({0.25f, height, 0.25f}, 1);
    light.radius = 0.1f;
    builder.description.lights = {light};

    Settings settings = test::uncut();
    settings.effects = EffectSet::all().without(Effect::shadows);
    const RgbD seen = radianceAlong(builder.build(), {0.25, 1, 0.25}, {0, -1, 0}, settings);
    const double expected = height > 0 ? 1 / kPi / (0.1 * 0.1) : 0;
    EXPECT_NEAR(seen.x, expected, 1e-6 * expected) << height;
  }
}

TEST(Lights, BehindTheSurfaceGiveNothing) {
  SceneBuilder builder;
  builder.add(test::floorAt(0, 1, builder.add(test::diffuseMaterial(1))));
  builder.description.lights = {lightAt({0, -2, 0}, 1)};
  const Scene scene = builder.build();
  RayCounts counts;
  EXPECT_EQ(radianceAlong(scene, {0, 1, 0}, {0, -1, 0}, test::uncut(), &counts), RgbD());
  EXPECT_EQ(counts[RayKind::shadow], 0u) << "nothing to look for";
  EXPECT_GT(radianceAlong(scene, {0, -1, 0}, {0, 1, 0}).x, 0) << "surfaces have two sides";
}

// Hard case H36: both normals must face the light.
TEST(Lights, BehindEitherNormalGiveNothing) {
  Surfel s;
  s.diffuse = RgbD(1.0);
  s.view = s.geometricNormal = {0, 1, 0};
  s.shadingNormal = normalized(Vec3d{1, 1, 0});

  EXPECT_EQ(radianceFromLight(EffectSet::all(), s, lightAt({2, -1, 0}, 1)).radiance, RgbD());
  EXPECT_EQ(radianceFromLight(EffectSet::all(), s, lightAt({-2, 1, 0}, 1)).radiance, RgbD());
  EXPECT_GT(radianceFromLight(EffectSet::all(), s, lightAt({2, 1, 0}, 1)).radiance.x, 0);
}

Light spotAt(const Vec3f& position, float intensity, float inner, float outer) {
  Light light = lightAt(position, intensity);
  light.kind = Light::Kind::spot;
  light.innerConeAngle = inner;
  light.outerConeAngle = outer;
  return light;
}

double degrees(double x) { return x * kPi / 180; }

// Looks at a white floor 2 below the light, at the point that the light sees at `angle`.
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

  // Radiance I / pi cos / d^2 of a light that shines in all directions.
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
    EXPECT_EQ(counts[RayKind::shadow], 0u) << "nothing to look for";
  }
}

// KHR_lights_punctual squares (cos - cosOuter) / (cosInner - cosOuter).
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

  // The direction leads to the point at 30 degrees.
  light.direction = Vec3f(Vec3d{std::sin(degrees(30)), -std::cos(degrees(30)), 0} * 1e-20);
  EXPECT_NEAR(seenAt(light, 30), allAround(30), 1e-6);  // the direction is rounded to float
  EXPECT_EQ(seenAt(light, 27), 0);
  EXPECT_EQ(seenAt(light, 33), 0);
}

// Hard case H67: cosines are within a few ulps of the edges, and some cones are so narrow that they
// have no width.
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

// The radiance is E kd / pi cos, wherever the surface lies.
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

// Hard case H67: light arrives along the surface, or from behind it.
TEST(DirectionalLight, H67_givesNothingFromTheHorizonOrBelow) {
  SceneBuilder builder;
  builder.add(test::floorAt(0, 1, builder.add(test::diffuseMaterial(1))));
  builder.description.lights = {sun({1, 0, 0}, 1), sun({0, 1, 0}, 1), sun({1, 1e-30f, 0}, 1)};
  RayCounts counts;
  EXPECT_EQ(radianceAlong(builder.build(), {0, 1, 0}, {0, -1, 0}, test::uncut(), &counts), RgbD());
  EXPECT_EQ(counts[RayKind::shadow], 0u);
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

// A white surface 2 below a light of intensity 4 pi has the radiance 4 pi / 4 / pi = 1.
TEST(FindRadianceReference, LooksFromTheSurfelToTheLight) {
  const Scene scene = SceneBuilder().build();
  test::SmallChunk small(scene, FeatureSet::all().without(Feature::shadowOffset));
  const Light light = lightAt({0, 2, 0}, static_cast<float>(4 * kPi));
  small.chunk.light = &light;

  test::setRay(small.chunk.rays, 0, {0, 1, 0}, {0, -1, 0});
  small.chunk.surfels.ng.y[0] = small.chunk.surfels.ns.y[0] = 1;
  small.chunk.surfels.diffuse.x[0] = 1;
  small.chunk.surfels.offset[0] = 0.0625f;

  const auto unshadowed = findRadiance(small.world, small.chunk, 0);
  const auto shadow = findShadowRay(small.world, small.chunk, 0);
  ASSERT_TRUE(unshadowed && shadow);
  EXPECT_NEAR(unshadowed->rgb.x, 1, 1e-7);
  EXPECT_EQ(unshadowed->rgb.y, 0);
  EXPECT_EQ(unshadowed->visible, 0) << "not yet known";

  EXPECT_GE(shadow->org.y, 0.0625);
  EXPECT_EQ(shadow->org.y + shadow->dir.y, 2);
  EXPECT_TRUE(shadow->tFar > 0.9999 && shadow->tFar < 1);

  small.chunk.surfels.ng.y[0] = -1;
  EXPECT_FALSE(findRadiance(small.world, small.chunk, 0));
}

}  // namespace
}  // namespace whit::reference
