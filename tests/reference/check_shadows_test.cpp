// Shadows: where they begin and end, and which objects cast them.
#include "reference/check_shadows.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "reference/small_scenes.h"

namespace whit::reference {
namespace {

using namespace test;

// A screen at height 1 ends at x = 0. The light at (1, 2, 0) casts the border of its shadow to x =
// -1.
Scene screenWith(const Material& material) {
  SceneBuilder builder = withFloor(diffuseMaterial(1), 10);
  builder.add(quad({-9, 1, 5}, {0, 1, 5}, {0, 1, -5}, {-9, 1, -5}), material);
  builder.description.lights = {lightAt({1, 2, 0}, 1)};
  return builder.build();
}

// Looks at the floor from below the screen.
double seenBelowScreen(const Scene& scene, double x, const Settings& settings = uncut()) {
  return radianceBelow(scene, {x, 0.5, 0}, settings).x;
}

double lit(double x) { return 2 / kPi * std::pow((1 - x) * (1 - x) + 4, -1.5); }

TEST(Shadows, BorderIsWhereGeometryPutsIt) {
  // The shadow ray starts up to offset = 32 u (10 + 10) above the floor, which moves the border as
  // far.
  constexpr double kOffset = 32 * 20 / 16777216.0;
  const Scene scene = screenWith(diffuseMaterial(1));
  for (const double step : {2 * kOffset, 1e-3, 0.5}) {
    EXPECT_NEAR(seenBelowScreen(scene, -1 + step), lit(-1 + step), 1e-12) << step;
    EXPECT_EQ(seenBelowScreen(scene, -1 - step), 0) << step;
  }

  EXPECT_NEAR(seenBelowScreen(scene, -3, without(Effect::shadows)), lit(-3), 1e-12);
  EXPECT_EQ(seenBelowScreen(scene, 0.5, without(Effect::lights)), 0);
}

TEST(Shadows, AreCastByGlassAndNotByMaterialsThatCastNone) {
  Material screen = glassMaterial(1.5f);
  EXPECT_EQ(seenBelowScreen(screenWith(screen), -3), 0);
  screen.castsShadow = false;
  EXPECT_NEAR(seenBelowScreen(screenWith(screen), -3), lit(-3), 1e-12);
}

// Occluders count at any distance, but not behind the surface.
TEST(DirectionalLight, ShadowsReachToTheEndOfTheScene) {
  for (const float height : {0.01f, 10.0f, 1e6f}) {
    SceneBuilder builder = withFloor(diffuseMaterial(1), 10);
    builder.add(floorAt(-5, 10, 0));

    // The light comes down from +x at 45 degrees: a screen at `height` darkens the floor as far to
    // the left.
    Mesh screen = floorAt(height, 1, 0);
    for (Vec3f& corner : screen.positions) corner.x += height;
    builder.add(screen);

    builder.description.lights = {sun({-1, -1, 0}, 1)};
    const Scene scene = builder.build();

    // The ray starts just above the floor, below the screen.
    EXPECT_EQ(radianceBelow(scene, {0, 0.005, 0}).x, 0) << height;
    EXPECT_NEAR(radianceBelow(scene, {5, 0.005, 0}).x, 1 / kPi * std::sqrt(0.5), 1e-9);
  }
}

// The screen is at a quarter of the ray. It occludes rays that end behind it, but none that end
// before it, start behind it or pass beside it.
TEST(CheckShadows, WhatEndsBeforeTheScreenIsVisible) {
  const Scene scene = withFloor(blackMaterial()).build();
  const BruteForce bruteForce(scene);

  const Ray down{{0.25, 1, 0.5}, {0, -4, 0}};
  EXPECT_TRUE(isVisible(bruteForce, down, 0.2499));
  EXPECT_FALSE(isVisible(bruteForce, down, 0.2501));
  EXPECT_TRUE(isVisible(bruteForce, {{0.25, -0.001, 0.5}, {0, -4, 0}}, 1));
  EXPECT_TRUE(isVisible(bruteForce, {{1.001, 1, 0.5}, {0, -4, 0}}, 1));
}

}  // namespace
}  // namespace whit::reference
