// Glass in a white room, and tinted glass (hard cases H43, H49, H50).
#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "reference/small_scenes.h"
#include "rounding.h"

namespace whit::reference {
namespace {

using namespace test;

TEST(Furnace, SplitsAsTheSeriesSays) {
  SceneBuilder builder;
  addSlab(builder, 0, -1, glassMaterial(1.5f));
  whiteAbove(builder);
  EXPECT_NEAR(radianceBelow(builder.build(), {0, 2, 0}, uncut(40)).x, 2 * 0.04 / 1.04, 1e-12);
}

// Calls seen(radiance, i) for rays from all around to a turned box of the material in a white room.
template <typename Seen>
void lookAtTurnedBox(const Material& material, const Seen& seen) {
  SceneBuilder builder;
  builder.place({"box", {box({-1, -0.5f, -1}, {1, 0.5f, 1}, builder.add(material))}},
                {Affine::rotation({1, 2, 3}, 33)});
  builder.sky(1);
  const Scene scene = builder.build();

  Numbers numbers(13);
  for (int i = 0; i < 300; ++i) {
    const Vec3d eye = numbers.direction() * 5.0;
    const Vec3d target{numbers.in(-0.9, 0.9), numbers.in(-0.4, 0.4), numbers.in(-0.9, 0.9)};
    seen(radianceAlong(scene, eye, target - eye, uncut(64)), i);
  }
}

// Any convex piece of glass in a white room is as bright as the room from everywhere.
TEST(Furnace, BoxVanishes) {
  lookAtTurnedBox(glassMaterial(1.5f), [](const RgbD& seen, int i) {
    EXPECT_LE(seen.x, 1 + 1e-12) << i;
    EXPECT_GE(seen.x, 1 - 1e-4) << i;
  });
}

Material coatedGlass(float mirror, const Rgb& transmission) {
  Material m = glassMaterial(1.5f);
  m.mirror = m.mirrorGrazing = Rgb(mirror);
  m.transmission = transmission;
  return m;
}

// Returns the radiance of a slab at normal incidence, up to the `inside`-th reflection within.
RgbD seenOfSlab(const Material& material, int inside) {
  SceneBuilder builder;
  addSlab(builder, 0, -1, material);
  builder.sky(1);
  return radianceBelow(builder.build(), {0, 2, 0}, uncut(inside + 1));
}

// What both faces of the slab reflect.
double reflectedBy(float mirror) { return 0.04 + 0.96 * double{mirror}; }

// All light comes back, except what is still inside at the deepest impulse (hard case H43). A
// mirror coat takes its share from the light that glass reflects and transmits: both faces reflect
// R = m + (1 - m) F and transmit the rest.
TEST(Furnace, SlabLosesOnlyTheTail) {
  for (const float mirror : {0.0f, 0.05f, 0.2f, 0.5f, 1.0f}) {
    const double r = reflectedBy(mirror);
    for (const int inside : {1, 2, 8, 64}) {
      const double seen = seenOfSlab(coatedGlass(mirror, Rgb(1.0f)), inside).x;
      EXPECT_NEAR(seen, 1 - std::pow(r, inside) * (1 - r), 1e-14) << mirror << " " << inside;
    }
  }
}

// The radiance is R + T^2 (1 + R + R^2 + ...), where T = (1 - F) t. A transmission t of 0.9 leaves
// room for a mirror of 0.05. A mirror of 0.2 reduces it to 0.8, by the same factor in all channels.
TEST(Furnace, CoatTakesWhatTintedGlassAbsorbsFirst) {
  const RgbD tint(Rgb{0.9f, 0.6f, 0.3f});
  for (const float mirror : {0.05f, 0.2f}) {
    const double r = reflectedBy(mirror);
    const RgbD t = tint * (0.96 * (mirror < 0.1f ? 1 : (1 - double{mirror}) / tint.x));
    const RgbD wanted = RgbD(r) + t * t / (1 - r);

    const RgbD seen = seenOfSlab(coatedGlass(mirror, Rgb(tint)), 64);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(seen[i], wanted[i], 1e-14) << mirror << " channel " << i;
      EXPECT_LE(seen[i], 1 + 1e-14);
    }
  }
}

// Rays come from all sides and at all angles. The mirror grows towards grazing incidence.
TEST(Furnace, CoatedBoxIsNoBrighterThanTheRoom) {
  Material coated = coatedGlass(0.2f, {1, 0.9f, 0.5f});
  coated.mirrorGrazing = Rgb(1.0f);
  lookAtTurnedBox(coated, [](const RgbD& seen, int i) {
    EXPECT_LE(maxComponent(seen), 1 + 1e-12) << i;
    EXPECT_GE(maxComponent(seen), 0.9) << i;
  });
}

// At either face the path is cut short by offset = 32 u (|x| + |y| + |z|) of the interpolated
// magnitudes, which are at most 4 + 1 + 4.
constexpr double kOffsetsOfTwoFaces = 2 * 32 * 9 / 16777216.0;

// Hard case H50: the transmittance is exp(-sigma * length of the path inside).
TEST(Absorption, DependsOnThePathInside) {
  SceneBuilder builder;
  Material tinted = glassMaterial(1);
  tinted.absorption = {1, 0.5f, 0};
  addSlab(builder, 0, -1, tinted, 4);
  builder.sky(1);
  const Scene scene = builder.build();

  for (const double degrees : {0.0, 30.0, 60.0}) {
    const double path = 1 / std::cos(degrees * kPi / 180);
    const RgbD seen = radianceAlong(scene, {0, 1, 0}, steep(degrees));
    expectNear(seen, {std::exp(-path), std::exp(-path / 2), 1}, kOffsetsOfTwoFaces);
    EXPECT_EQ(seen.z, 1);

    EXPECT_EQ(radianceAlong(scene, {0, 1, 0}, steep(degrees), without(Effect::absorption)),
              RgbD(1.0));
  }
}

// Behind an interface without a far side, any absorption absorbs everything (hard case H49).
TEST(Absorption, OpenSurfaceLeadsToInfinity) {
  Material tinted = glassMaterial(1);
  tinted.absorption = {1e-3f, 0, 0};
  EXPECT_EQ(radianceBelow(floorUnderSky(tinted)), RgbD(0, 1, 1));
}

// The cutoff includes absorption.
TEST(Absorption, ShortensPathsThroughTheCutoff) {
  SceneBuilder builder;
  Material dark = glassMaterial(1);
  dark.absorption = Rgb(10.0f);
  addSlab(builder, 0, -1, dark);
  builder.sky(1);

  Settings settings = uncut();
  settings.options.cutoff = 1e-3f;
  RayCounts counts;
  EXPECT_EQ(radianceBelow(builder.build(), {0, 1, 0}, settings, &counts), RgbD());
  EXPECT_EQ(counts[RayKind::refraction], 1u)
      << "exp(-10) is below the cutoff: the way out is not traced";
}

}  // namespace
}  // namespace whit::reference
