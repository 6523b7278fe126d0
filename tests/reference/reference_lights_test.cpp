// Emission, ambient light, point lights and their shadows against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "reference/shading.h"
#include "reference/small_scenes.h"

namespace whit::reference {
namespace {

using test::lightAt;
using test::radianceAlong;
using test::SceneBuilder;

// What the camera should see at pixel (x, y) of a w x h image, from 5 above a floor that spans
// y = 0, looking down with -z up: the point on the floor.
Vec3d pointOnFloor(double x, double y, int w, int h, double fovDegrees) {
  const double half = 5 * std::tan(fovDegrees * kPi / 360);
  return {(x + 0.5 - w / 2.0) / (h / 2.0) * half, 0, (y + 0.5 - h / 2.0) / (h / 2.0) * half};
}

// L = kd / pi * I cos / d^2 at every pixel center.
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
      // One rounding to float at the end.
      EXPECT_NEAR(image.at(x, y).x, expected, 1e-7 * expected) << x << ", " << y;
    }
  }
  EXPECT_EQ(counts.primary, 63u);
  EXPECT_EQ(counts.shadow, 63u);
  EXPECT_EQ(counts.reflection + counts.refraction, 0u);
}

TEST(Lights, AddUpAndKeepTheirColors) {
  SceneBuilder builder;
  Material m = test::diffuseMaterial(1);
  m.diffuse = {1, 0.5f, 0.25f};
  builder.add(test::floorAt(0, 10, builder.add(m)));
  builder.description.lights = {lightAt({0, 2, 0}, 4), lightAt({0, 3, 0}, 9)};
  builder.description.lights[1].intensity = {0, 9, 18};
  const RgbD seen = radianceAlong(builder.build(), {0, 1, 0}, {0, -1, 0});
  EXPECT_NEAR(seen.x, 1 / kPi, 1e-12);
  EXPECT_NEAR(seen.y, 0.5 / kPi * 2, 1e-12);
  EXPECT_NEAR(seen.z, 0.25 / kPi * 3, 1e-12);
}

// Hard case H65: near the light its radius bounds the radiance; at the light there is none.
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
  EXPECT_EQ(counts.shadow, 0u) << "nothing to look for";
  EXPECT_GT(radianceAlong(scene, {0, -1, 0}, {0, 1, 0}).x, 0) << "surfaces have two sides";
}

// Hard case H36: both normals must see the light.
TEST(Lights, BehindEitherNormalGiveNothing) {
  Surfel s;
  s.diffuse = RgbD(1.0);
  s.view = s.geometricNormal = {0, 1, 0};
  s.shadingNormal = normalized(Vec3d{1, 1, 0});
  EXPECT_EQ(radianceFromLight(EffectSet::all(), s, lightAt({2, -1, 0}, 1)).radiance, RgbD());
  EXPECT_EQ(radianceFromLight(EffectSet::all(), s, lightAt({-2, 1, 0}, 1)).radiance, RgbD());
  EXPECT_GT(radianceFromLight(EffectSet::all(), s, lightAt({2, 1, 0}, 1)).radiance.x, 0);
}

// A screen at height 1 ends at x = 0; the light at (1, 2, 0) draws its border at x = -1.
class ShadowTest : public ::testing::Test {
 protected:
  Scene screenWith(Material material) {
    SceneBuilder builder;
    builder.add(test::floorAt(0, 10, builder.add(test::diffuseMaterial(1))));
    builder.add(test::quad({-9, 1, 5}, {0, 1, 5}, {0, 1, -5}, {-9, 1, -5}, builder.add(material)));
    builder.description.lights = {lightAt({1, 2, 0}, 1)};
    return builder.build();
  }
  // Looking at the floor from below the screen.
  double seenAt(const Scene& scene, double x, EffectSet effects = EffectSet::all()) {
    Settings settings = test::uncut();
    settings.effects = effects;
    return radianceAlong(scene, {x, 0.5, 0}, {0, -1, 0}, settings).x;
  }
  static double lit(double x) {
    const double d2 = (1 - x) * (1 - x) + 4;
    return 1 / kPi * 2 / std::sqrt(d2) / d2;
  }
  // The shadow ray starts up to offset = 32 u (10 + 10) above the floor, and the border moves as
  // far.
  static constexpr double kOffset = 32 * 20 / 16777216.0;
};

TEST_F(ShadowTest, BorderIsWhereGeometryPutsIt) {
  const Scene scene = screenWith(test::diffuseMaterial(1));
  for (const double step : {2 * kOffset, 1e-3, 0.5}) {
    EXPECT_NEAR(seenAt(scene, -1 + step), lit(-1 + step), 1e-12) << step;
    EXPECT_EQ(seenAt(scene, -1 - step), 0) << step;
  }
  EXPECT_NEAR(seenAt(scene, -3, EffectSet::all().without(Effect::shadows)), lit(-3), 1e-12);
  EXPECT_EQ(seenAt(scene, 0.5, EffectSet::all().without(Effect::lights)), 0);
}

TEST_F(ShadowTest, SomeMaterialsCastNone) {
  Material ghost = test::diffuseMaterial(1);
  ghost.castsShadow = false;
  EXPECT_NEAR(seenAt(screenWith(ghost), -3), lit(-3), 1e-12);
}

TEST_F(ShadowTest, GlassCastsOne) {
  EXPECT_EQ(seenAt(screenWith(test::glassMaterial(1.5f)), -3), 0);
}

// Hard case H8: a light on a ceiling lights the floor; one just behind it does not.
TEST(Shadows, LightOnASurface) {
  for (const float height : {2.0f, std::nextafter(2.0f, 1.0f), 2.001f}) {
    SceneBuilder builder;
    const auto gray = builder.add(test::diffuseMaterial(1));
    builder.add(test::floorAt(0, 3, gray));
    builder.add(test::ceilingAt(2, 3, gray));
    builder.description.lights = {lightAt({0.3f, height, 0.1f}, 1)};
    const double seen = radianceAlong(builder.build(), {0.5, 1, 0.5}, {0, -1, 0}).x;
    EXPECT_EQ(seen > 0, height <= 2) << height;
  }
}

// Hard cases H6, H7, H66: no light leaves a closed box, none comes in, and inside all is lit.
TEST(Shadows, ClosedBoxesAreTight) {
  test::Numbers numbers(9);
  SceneBuilder inside, outside;
  for (SceneBuilder* builder : {&inside, &outside}) {
    const auto gray = builder->add(test::diffuseMaterial(1));
    builder->add(test::box({-1, -1, -1}, {1, 1, 1}, gray));
    builder->add(test::box({-4, -4, -4}, {4, 4, 4}, gray));
  }
  inside.description.lights = {lightAt({0.3f, -0.2f, 0.1f}, 1)};
  outside.description.lights = {lightAt({2.3f, -2.2f, 2.1f}, 1)};
  const Scene a = inside.build(), b = outside.build();
  for (int i = 0; i < 5000; ++i) {
    // From the middle to anywhere on the inner walls, most of all to the edges.
    Vec3d target = numbers.direction();
    target = target / maxComponent(abs(target));
    if (i % 3) target[i % 2] = target[i % 2] < 0 ? -1 + 1e-8 * i : 1 - 1e-8 * i;
    EXPECT_GT(radianceAlong(a, {0, 0, 0}, target).x, 0) << i;
    EXPECT_EQ(radianceAlong(b, {0, 0, 0}, target).x, 0) << i;
    // From between the boxes onto the inner one.
    EXPECT_EQ(radianceAlong(a, target * 3.0, -target).x, 0) << i;
  }
}

TEST(Ambient, FollowsTheNormal) {
  Scene scene;
  scene.materials.resize(1);
  scene.ambient = {Rgb(3.0f), Rgb(1.0f)};
  Surfel s;
  s.diffuse = {1, 0.5, 0};
  s.shadingNormal = {0, 1, 0};
  EXPECT_EQ(emittedAndAmbient(scene, EffectSet::all(), s), RgbD(3, 1.5, 0));
  s.shadingNormal = {0, -1, 0};
  EXPECT_EQ(emittedAndAmbient(scene, EffectSet::all(), s), RgbD(1, 0.5, 0));
  s.shadingNormal = {1, 0, 0};
  EXPECT_EQ(emittedAndAmbient(scene, EffectSet::all(), s), RgbD(2, 1, 0));
  EXPECT_EQ(emittedAndAmbient(scene, EffectSet::all().without(Effect::ambient), s), RgbD());
}

TEST(Emission, AddsToTheRest) {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].emission = {1, 2, 3};
  Surfel s;
  EXPECT_EQ(emittedAndAmbient(scene, EffectSet::all(), s), RgbD(1, 2, 3));
  EXPECT_EQ(emittedAndAmbient(scene, EffectSet::all().without(Effect::emission), s), RgbD());
}

TEST(Sky, NeedsItsEffects) {
  SceneBuilder builder;
  builder.sky(2);
  const Scene plain = builder.build();
  EXPECT_EQ(skyAlong(plain, EffectSet::all(), {0, 1, 0}), RgbD(2.0));
  EXPECT_EQ(skyAlong(plain, EffectSet::all().without(Effect::skyImage), {0, 1, 0}), RgbD(2.0));
  EXPECT_EQ(skyAlong(plain, EffectSet::all().without(Effect::sky), {0, 1, 0}), RgbD());
  SceneBuilder withImage;
  withImage.description.sky.kind = Sky::Kind::image;
  withImage.description.sky.image = {1, 1, {1}, {2}, {3}};
  const Scene image = withImage.build();
  EXPECT_EQ(skyAlong(image, EffectSet::all(), {0, 1, 0}), RgbD(1, 2, 3));
  EXPECT_EQ(skyAlong(image, EffectSet::all().without(Effect::skyImage), {0, 1, 0}), RgbD());
}

}  // namespace
}  // namespace whit::reference
