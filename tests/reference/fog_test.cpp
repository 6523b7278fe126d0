// Fog of the air: along a way of length t, L becomes L exp(-sigma t) + C (1 - exp(-sigma t)).
#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "reference/small_scenes.h"

namespace whit::reference {
namespace {

using test::ceilingAt;
using test::floorAt;
using test::radianceAlong;
using test::SceneBuilder;

// The tests compute with the values of these floats.
constexpr float kDensity = 0.25f, kColor = 0.5f;

// Roundings of doubles, and offsets of rays, which are as small as roundings of floats.
constexpr double kOffsets = 1e-5;

double left(double distance) { return std::exp(-double{kDensity} * distance); }
double behind(double distance, double radiance) {
  return radiance * left(distance) + double{kColor} * (1 - left(distance));
}

SceneBuilder foggy() {
  SceneBuilder builder;
  builder.description.fog = {Rgb(kDensity), Rgb(kColor)};
  return builder;
}

TEST(Fog, LiesBeforeAWall) {
  SceneBuilder builder = foggy();
  builder.add(floorAt(0, 10, builder.add(test::emittingMaterial(3))));
  const Scene scene = builder.build();
  for (const double t : {0.5, 3.0, 50.0}) {
    EXPECT_NEAR(radianceAlong(scene, {0, t, 0}, {0, -1, 0}).x, behind(t, 3), kOffsets);
  }
}

TEST(Fog, DimsChannelsByThemselves) {
  SceneBuilder builder = foggy();
  builder.description.fog.density = {0, kDensity, 0};
  builder.add(floorAt(0, 10, builder.add(test::emittingMaterial(3))));
  builder.sky(2);
  const Scene scene = builder.build();
  const RgbD wall = radianceAlong(scene, {0, 4, 0}, {0, -1, 0});
  EXPECT_EQ(wall.x, 3);
  EXPECT_NEAR(wall.y, behind(4, 3), kOffsets);
  EXPECT_EQ(radianceAlong(scene, {0, 4, 0}, {0, 1, 0}), RgbD(2, double{kColor}, 2));
}

TEST(Fog, LiesOnBothWaysOfAMirroredPath) {
  SceneBuilder builder = foggy();
  builder.add(floorAt(0, 10, builder.add(test::mirrorMaterial(0.5f))));
  builder.add(ceilingAt(5, 10, builder.add(test::emittingMaterial(3))));
  const Scene scene = builder.build();
  const double seen = radianceAlong(scene, {0, 2, 0}, {0, -1, 0}).x;
  EXPECT_NEAR(seen, behind(2, 0.5 * behind(5, 3)), kOffsets);
}

// Glass of the air's refractive index bends and reflects nothing.
TEST(Fog, IsNotInsideOfGlass) {
  SceneBuilder builder = foggy();
  test::addSlab(builder, 0, -1, builder.add(test::glassMaterial(1)), 10);
  builder.add(floorAt(-3, 10, builder.add(test::emittingMaterial(3))));
  const Scene scene = builder.build();
  EXPECT_NEAR(radianceAlong(scene, {0, 2, 0}, {0, -1, 0}).x, behind(2, behind(2, 3)), kOffsets);
}

TEST(Fog, DimsALightByItsDistance) {
  SceneBuilder builder = foggy();
  builder.add(floorAt(0, 10, builder.add(test::diffuseMaterial(0.5f))));
  builder.description.lights = {test::lightAt({0, 2, 0}, 8)};
  const Scene scene = builder.build();
  const double floor = 0.5 / kPi * 8 / 4 * left(2);
  EXPECT_NEAR(radianceAlong(scene, {0, 3, 0}, {0, -1, 0}).x, behind(3, floor), kOffsets);
}

TEST(Fog, LeavesTheSunAsItIs) {
  SceneBuilder builder = foggy();
  builder.add(floorAt(0, 10, builder.add(test::diffuseMaterial(0.5f))));
  builder.description.lights = {test::sun({0, -1, 0}, 8)};
  const Scene scene = builder.build();
  EXPECT_NEAR(radianceAlong(scene, {0, 3, 0}, {0, -1, 0}).x, behind(3, 0.5 / kPi * 8), kOffsets);
}

// Mirrors and shining walls of radiance 1 vanish in fog of radiance 1, however dense it is.
TEST(Fog, OfTheRoomsRadianceKeepsIt) {
  test::Numbers numbers(60);
  for (int i = 0; i < 20; ++i) {
    SceneBuilder builder;
    const auto density = static_cast<float>(std::pow(10, numbers.in(-4, 2)));
    builder.description.fog = {Rgb(density), Rgb(1.0f)};
    const std::uint32_t materials[] = {builder.add(test::emittingMaterial(1)),
                                       builder.add(test::mirrorMaterial(1))};
    for (int k = 0; k < 20; ++k) {
      const Vec3f low(numbers.direction() * numbers.in(1, 5));
      const Vec3f size(Vec3d{numbers.in(0.1, 1), numbers.in(0.1, 1), numbers.in(0.1, 1)});
      builder.add(test::box(low, low + size, materials[k % 2]));
    }
    builder.sky(1);

    const Scene scene = builder.build();
    for (int k = 0; k < 20; ++k) {
      const double seen = radianceAlong(scene, {}, numbers.direction(), test::uncut(200)).x;
      EXPECT_NEAR(seen, 1, 1e-12) << density;
    }
  }
}

}  // namespace
}  // namespace whit::reference
