// Fog of the air: along a way of length t, L becomes L exp(-sigma t) + C (1 - exp(-sigma t)).
#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "reference/small_scenes.h"
#include "rounding.h"

namespace whit::reference {
namespace {

using namespace test;

// The tests compute with the values of these floats.
constexpr float kDensity = 0.25f, kColor = 0.5f;

// Roundings of doubles, and offsets of rays, which are as small as roundings of floats.
constexpr double kOffsets = 1e-5;

double left(double distance) { return std::exp(-double{kDensity} * distance); }
double behind(double distance, double radiance) {
  return radiance * left(distance) + double{kColor} * (1 - left(distance));
}

SceneBuilder foggyFloor(const Material& material) {
  SceneBuilder builder = withFloor(material, 10);
  builder.description.fog = {Rgb(kDensity), Rgb(kColor)};
  return builder;
}

TEST(Fog, LiesBeforeAWall) {
  const Scene scene = foggyFloor(emittingMaterial(3)).build();
  for (const double t : {0.5, 3.0, 50.0}) {
    EXPECT_NEAR(radianceBelow(scene, {0, t, 0}).x, behind(t, 3), kOffsets);
  }
}

TEST(Fog, DimsChannelsByThemselves) {
  SceneBuilder builder = foggyFloor(emittingMaterial(3));
  builder.description.fog.density = {0, kDensity, 0};
  builder.sky(2);
  const Scene scene = builder.build();
  expectNear(radianceBelow(scene, {0, 4, 0}), {3, behind(4, 3), 3}, kOffsets);
  EXPECT_EQ(radianceAlong(scene, {0, 4, 0}, {0, 1, 0}), RgbD(2, double{kColor}, 2));
}

TEST(Fog, LiesOnBothWaysOfAMirroredPath) {
  SceneBuilder builder = foggyFloor(mirrorMaterial(0.5f));
  builder.add(ceilingAt(5, 10), emittingMaterial(3));
  EXPECT_NEAR(radianceBelow(builder.build(), {0, 2, 0}).x, behind(2, 0.5 * behind(5, 3)), kOffsets);
}

// Glass of the air's refractive index bends and reflects nothing.
TEST(Fog, IsNotInsideOfGlass) {
  SceneBuilder builder = foggyFloor(emittingMaterial(3));
  addSlab(builder, 3, 2, glassMaterial(1), 10);
  EXPECT_NEAR(radianceBelow(builder.build(), {0, 5, 0}).x, behind(2, behind(2, 3)), kOffsets);
}

// A lamp is dimmed by its distance. What the sun brings is what arrives.
TEST(Fog, DimsLampsAndLeavesTheSunAsItIs) {
  for (const auto& [light, irradiance] :
       {std::pair{lightAt({0, 2, 0}, 8), 8.0 / 4 * left(2)}, {sun({0, -1, 0}, 8), 8.0}}) {
    SceneBuilder builder = foggyFloor(diffuseMaterial(0.5f));
    builder.description.lights = {light};
    EXPECT_NEAR(radianceBelow(builder.build(), {0, 3, 0}).x, behind(3, 0.5 / kPi * irradiance),
                kOffsets);
  }
}

// Mirrors and shining walls of radiance 1 vanish in fog of radiance 1, however dense it is.
TEST(Fog, OfTheRoomsRadianceKeepsIt) {
  Numbers numbers(60);
  for (int i = 0; i < 20; ++i) {
    SceneBuilder builder;
    const auto density = static_cast<float>(std::pow(10, numbers.in(-4, 2)));
    builder.description.fog = {Rgb(density), Rgb(1.0f)};
    builder.add(emittingMaterial(1));
    builder.add(mirrorMaterial(1));
    for (std::uint32_t k = 0; k < 20; ++k) {
      const Vec3f low(numbers.direction() * numbers.in(1, 5));
      const Vec3f size(Vec3d{numbers.in(0.1, 1), numbers.in(0.1, 1), numbers.in(0.1, 1)});
      builder.add(box(low, low + size, k % 2));
    }
    builder.sky(1);

    const Scene scene = builder.build();
    for (int k = 0; k < 20; ++k) {
      const double seen = radianceAlong(scene, {}, numbers.direction(), uncut(200)).x;
      EXPECT_NEAR(seen, 1, 1e-12) << density;
    }
  }
}

}  // namespace
}  // namespace whit::reference
