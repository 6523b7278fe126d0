// Reflected impulses: directions, weights, depth and cutoff (hard cases H32, H33, H62, H64).
#include "reference/add_impulses.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/small_scenes.h"
#include "rounding.h"

namespace whit::reference {
namespace {

using namespace test;

// Returns a scene whose floor has the material. Surfels of it lie at the origin.
Scene floorOf(const Material& material) { return withFloor(material).build(); }

Surfel surfelSeen(const Vec3d& view, const Vec3d& shadingNormal) {
  Surfel s;
  s.view = normalized(view);
  s.geometricNormal = {0, 1, 0};
  s.shadingNormal = normalized(shadingNormal);
  s.offset = 1e-3;
  s.viewOffset = 0.5e-3;
  s.entering = true;
  return s;
}

Impulses impulsesOf(const Scene& scene, const Surfel& s, EffectSet effects = EffectSet::all()) {
  return findImpulses(scene, effects, s, crossMedia(scene, effects, 0, s.entering, 0), 0);
}

TEST(Mirror, WeightFollowsSchlick) {
  Material m = mirrorMaterial(0.25f);
  m.mirrorGrazing = Rgb(0.75f);
  const Scene scene = floorOf(m);
  for (const double c : {1.0, 0.5, 0.1}) {
    const Surfel s = surfelSeen({std::sqrt(1 - c * c), c, 0}, {0, 1, 0});
    const Impulses found = impulsesOf(scene, s);
    EXPECT_NEAR(found.reflected.weight.x, 0.25 + 0.5 * std::pow(1 - c, 5), 1e-15) << c;
    EXPECT_EQ(found.refracted.weight, RgbD());
    EXPECT_EQ(impulsesOf(scene, s, allBut(Effect::mirror)).reflected.weight, RgbD());
  }
}

TEST(Mirror, StartsAboveTheSurface) {
  const Ray ray =
      impulsesOf(floorOf(mirrorMaterial(1)), surfelSeen({3, 4, 0}, {0, 1, 0})).reflected.ray;
  // The origin is moved by `offset` along the normal and by `viewOffset` towards the viewer.
  expectNear(ray.origin, {0.3e-3, 1.4e-3, 0}, 1e-15);
  expectNear(ray.direction, {-0.6, 0.8, 0}, 1e-15);
}

// Hard case H32: a tilted shading normal never sends light into the surface.
TEST(Lift, KeepsReflectionsAboveTheSurface) {
  const Scene scene = floorOf(mirrorMaterial(1));
  Numbers numbers(11);
  int raised = 0;
  for (int i = 0; i < 20000; ++i) {
    const double elevation = numbers.in(1e-4, 1.5), tilt = numbers.in(0, 1.05);
    const double turn = numbers.in(0, 6.3);
    const Vec3d normal{std::sin(tilt) * std::cos(turn), std::cos(tilt),
                       std::sin(tilt) * std::sin(turn)};

    const Surfel s = surfelSeen({std::cos(elevation), std::sin(elevation), 0}, normal);
    const Vec3d r = impulsesOf(scene, s).reflected.ray.direction;
    const double least = std::min(0.9 * std::sin(elevation), 0.01);
    EXPECT_NEAR(length(r), 1, 1e-15);

    // After the direction was raised it is normalized, which lowers its sine by at most half the
    // square of what was added.
    EXPECT_GE(r.y, least / 1.5);

    const Vec3d mirrored = s.shadingNormal * (2 * dot(s.view, s.shadingNormal)) - s.view;
    if (mirrored.y >= least) {
      expectNear(r, mirrored, 1e-14);
    } else {
      ++raised;
    }
  }

  EXPECT_GT(raised, 1000) << "the sweep was meant to reach the case";
}

TEST(Lift, IsContinuousAndIdempotent) {
  const Vec3d up{0, 1, 0};
  const Vec3d justBelow = normalized(Vec3d{1, 0.01 - 1e-9, 0}),
              just = normalized(Vec3d{1, 0.01, 0});
  expectNear(raised(justBelow, up, just.y), just, 1e-8);

  const Vec3d once = raised(normalized(Vec3d{1, -0.02, 0}), up, 0.01);
  expectNear(raised(once, up, 0.01), once, 1e-5);
  const Vec3d flat = normalized(Vec3d{0.3, 0.4, 0.5});
  EXPECT_EQ(raised(flat, up, 0.01), flat) << "not a bit changes where nothing is to be done";
}

// Hard case H33: the view is behind the shading normal.
TEST(Lift, ViewBehindTheShadingNormal) {
  Material m = mirrorMaterial(0.5f);
  m.transmission = Rgb(1.0f);
  const Surfel s = surfelSeen({-1, 0.1, 0}, {1, 0.5, 0});
  ASSERT_LT(dot(s.view, s.shadingNormal), 0);

  const Impulses found = impulsesOf(floorOf(m), s);
  EXPECT_TRUE(isFinite(found.reflected.ray.direction));
  EXPECT_GT(found.reflected.ray.direction.y, 0);
  EXPECT_NEAR(found.reflected.weight.x, 1, 1e-15) << "total reflection, coat or not";
  EXPECT_EQ(found.refracted.weight, RgbD());
}

// A closed box of glowing mirrors, whose radiance is a geometric series in the reflectance (hard
// case H62).
Scene hall(float reflectance) {
  Material m = mirrorMaterial(reflectance);
  m.emission = Rgb(1.0f);
  return sceneOf(box({-1, -1, -1}, {1, 1, 1}), m);
}

double seenInHall(const Scene& scene, const Settings& settings, RayCounts& counts) {
  return radianceAlong(scene, {0.1, 0.2, -0.3}, {0.31, -0.2, 0.93}, settings, &counts).x;
}

TEST(HallOfMirrors, SumsTheSeries) {
  for (const float r : {0.5f, 0.9f, 1.0f}) {
    const Scene scene = hall(r);
    for (const int depth : {0, 1, 8, 32, 64}) {
      double wanted = 1;
      for (int k = 0; k < depth; ++k) wanted = 1 + double{r} * wanted;

      RayCounts counts;
      EXPECT_NEAR(seenInHall(scene, uncut(depth), counts), wanted, r < 1 ? 1e-12 : 0);
      EXPECT_EQ(counts[RayKind::reflection], static_cast<std::uint64_t>(depth));
    }
  }
}

// Hard case H64: impulses that contribute less than the cutoff are not traced, and the image loses
// no more than their contribution.
TEST(HallOfMirrors, CutoffStopsWhatNoLongerCounts) {
  const Scene scene = hall(0.5f);
  Settings settings = uncut(64);
  const auto seenWith = [&](float cutoff, std::uint64_t reflections) {
    settings.options.cutoff = cutoff;
    RayCounts counts;
    const double seen = seenInHall(scene, settings, counts);
    EXPECT_EQ(counts[RayKind::reflection], reflections) << cutoff;
    return seen;
  };

  EXPECT_EQ(seenWith(0.1f, 3), 1.875);
  EXPECT_EQ(seenWith(0.125, 3), 1.875) << "what contributes just the cutoff is traced";
  EXPECT_EQ(seenWith(0.126f, 2), 1.75);
  EXPECT_EQ(seenWith(2, 0), 1);
}

TEST(HallOfMirrors, DisabledMirrorsReflectNothing) {
  RayCounts counts;
  EXPECT_EQ(seenInHall(hall(1), without(Effect::mirror), counts), 1);
  EXPECT_EQ(counts[RayKind::reflection], 0u);
}

}  // namespace
}  // namespace whit::reference
