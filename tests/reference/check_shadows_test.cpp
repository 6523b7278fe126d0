// Shadows: where they begin and end, and which objects cast them.
#include "reference/check_shadows.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "reference/small_chunk.h"
#include "reference/small_scenes.h"

namespace whit::reference {
namespace {

using test::lightAt;
using test::radianceAlong;
using test::SceneBuilder;
using test::sun;

// A screen at height 1 ends at x = 0. The light at (1, 2, 0) casts the border of its shadow to x =
// -1.
class ShadowTest : public ::testing::Test {
 protected:
  Scene screenWith(Material material) {
    SceneBuilder builder;
    builder.add(test::floorAt(0, 10, builder.add(test::diffuseMaterial(1))));
    builder.add(test::quad({-9, 1, 5}, {0, 1, 5}, {0, 1, -5}, {-9, 1, -5}, builder.add(material)));
    builder.description.lights = {lightAt({1, 2, 0}, 1)};
    return builder.build();
  }

  // Looks at the floor from below the screen.
  double seenAt(const Scene& scene, double x, EffectSet effects = EffectSet::all()) {
    Settings settings = test::uncut();
    settings.effects = effects;
    return radianceAlong(scene, {x, 0.5, 0}, {0, -1, 0}, settings).x;
  }

  static double lit(double x) {
    const double d2 = (1 - x) * (1 - x) + 4;
    return 1 / kPi * 2 / std::sqrt(d2) / d2;
  }

  // The shadow ray starts up to offset = 32 u (10 + 10) above the floor, which moves the border as
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

// Hard cases H6, H7, H66: no light leaves a closed box, none enters, and the whole inside is lit.
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
    // The target is anywhere on the inner walls, mostly near their edges.
    Vec3d target = numbers.direction();
    target = target / maxComponent(abs(target));
    if (i % 3) target[i % 2] = target[i % 2] < 0 ? -1 + 1e-8 * i : 1 - 1e-8 * i;
    EXPECT_GT(radianceAlong(a, {0, 0, 0}, target).x, 0) << i;
    EXPECT_EQ(radianceAlong(b, {0, 0, 0}, target).x, 0) << i;

    // The ray runs from between the boxes to the inner one.
    EXPECT_EQ(radianceAlong(a, target * 3.0, -target).x, 0) << i;
  }
}

// Occluders count at any distance, but not behind the surface.
TEST(DirectionalLight, ShadowsReachToTheEndOfTheScene) {
  for (const float height : {0.01f, 10.0f, 1e6f}) {
    SceneBuilder builder;
    const auto gray = builder.add(test::diffuseMaterial(1));
    builder.add(test::floorAt(0, 10, gray));
    builder.add(test::floorAt(-5, 10, gray));

    // The light comes down from +x at 45 degrees: a screen at `height` darkens the floor as far to
    // the left.
    const float x = height;
    builder.add(test::quad({x - 1, height, 1}, {x + 1, height, 1}, {x + 1, height, -1},
                           {x - 1, height, -1}, gray));

    builder.description.lights = {sun({-1, -1, 0}, 1)};
    const Scene scene = builder.build();

    // The ray starts just above the floor, below the screen.
    EXPECT_EQ(radianceAlong(scene, {0, 0.005, 0}, {0, -1, 0}).x, 0) << height;
    EXPECT_NEAR(radianceAlong(scene, {5, 0.005, 0}, {0, -1, 0}).x, 1 / kPi * std::sqrt(0.5), 1e-9);
  }
}

TEST(BruteForce, OccludersLieBetween) {
  SceneBuilder builder;
  builder.add(test::floorAt(1, 1, 0));
  const Scene scene = builder.build();
  const BruteForce bruteForce(scene);
  const Ray down{{0.25, 2, 0.5}, {0, -4, 0}};

  EXPECT_TRUE(bruteForce.occluded(down, 1));
  EXPECT_TRUE(bruteForce.occluded(down, 0.2501));
  EXPECT_FALSE(bruteForce.occluded(down, 0.2499));
}

// The screen is at a quarter of the ray. It occludes rays that end behind it, but none that end
// before it, start behind it or pass beside it.
TEST(CheckShadows, WhatEndsBeforeTheScreenIsVisible) {
  SceneBuilder builder;
  builder.add(test::floorAt(1, 1, 0));
  const Scene scene = builder.build();
  const BruteForce bruteForce(scene);

  const Ray down{{0.25, 2, 0.5}, {0, -4, 0}};
  EXPECT_TRUE(isVisible(bruteForce, down, 0.2499));
  EXPECT_FALSE(isVisible(bruteForce, down, 0.2501));
  EXPECT_TRUE(isVisible(bruteForce, {{0.25, 0.999, 0.5}, {0, -4, 0}}, 1));
  EXPECT_TRUE(isVisible(bruteForce, {{1.001, 2, 0.5}, {0, -4, 0}}, 1));
}

TEST(CheckShadowsReference, AnswersForTheSlotOfTheRay) {
  SceneBuilder builder;
  builder.add(test::floorAt(1, 1, 0));
  const Scene scene = builder.build();
  test::SmallChunk small(scene);
  for (const std::size_t k : {0u, 1u}) {
    test::setRay(small.chunk.shadows, k, {0.25f, 2, 0.5f}, {0, -4, 0});
    small.chunk.shadows.tFar[k] = k == 0 ? 0.2f : 0.3f;
    small.chunk.shadows.slot[k] = static_cast<std::uint32_t>(3 + k);
    small.chunk.unshadowed.rgb.x[3 + k] = static_cast<float>(k + 7);
  }

  const UnshadowedRow before = checkShadows(small.world, small.chunk, 0);
  EXPECT_EQ(before.visible, 1);
  EXPECT_EQ(before.rgb.x, 7) << "as it was";
  EXPECT_EQ(checkShadows(small.world, small.chunk, 1).visible, 0);
}

}  // namespace
}  // namespace whit::reference
