// Reflected impulses: directions, weights, depth and cutoff (hard cases H10, H32, H52, H62, H64,
// H79).
#include "reference/add_impulses.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/small_chunk.h"
#include "reference/small_scenes.h"

namespace whit::reference {
namespace {

using test::mirrorMaterial;
using test::radianceAlong;
using test::SceneBuilder;

// Returns a scene whose floor has the material. Surfels of it lie at the origin.
Scene sceneOf(const Material& material) {
  SceneBuilder builder;
  builder.add(test::floorAt(0, 1, builder.add(material)));
  return builder.build();
}

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
  const Scene scene = sceneOf(m);
  for (const double c : {1.0, 0.5, 0.1}) {
    const Surfel s = surfelSeen({std::sqrt(1 - c * c), c, 0}, {0, 1, 0});
    const Impulses found = impulsesOf(scene, s);
    EXPECT_NEAR(found.reflected.weight.x, 0.25 + 0.5 * std::pow(1 - c, 5), 1e-15) << c;
    EXPECT_EQ(found.refracted.weight, RgbD());

    const EffectSet dull = EffectSet::all().without(Effect::mirror);
    EXPECT_EQ(impulsesOf(scene, s, dull).reflected.weight, RgbD());
  }
}

TEST(Mirror, StartsAboveTheSurface) {
  const Impulses found = impulsesOf(sceneOf(mirrorMaterial(1)), surfelSeen({3, 4, 0}, {0, 1, 0}));
  // The origin is moved by `offset` along the normal and by `viewOffset` towards the viewer.
  EXPECT_NEAR(found.reflected.ray.origin.x, 0.3e-3, 1e-15);
  EXPECT_NEAR(found.reflected.ray.origin.y, 1.4e-3, 1e-15);
  EXPECT_NEAR(found.reflected.ray.direction.x, -0.6, 1e-15);
  EXPECT_NEAR(found.reflected.ray.direction.y, 0.8, 1e-15);
}

// Hard case H79: even the flattest views are reflected upwards.
TEST(Mirror, GrazingViewsReflectUpwards) {
  const Scene scene = sceneOf(mirrorMaterial(1));
  for (const double elevation : {1e-1, 1e-2, 1e-4, 1e-6, 1e-9}) {
    const Surfel s = surfelSeen({std::cos(elevation), std::sin(elevation), 0}, {0, 1, 0});
    const Vec3d r = impulsesOf(scene, s).reflected.ray.direction;
    EXPECT_GT(r.y, 0);
    EXPECT_NEAR(r.y, std::sin(elevation), 1e-15);
  }
}

// Hard case H32: a tilted shading normal never sends light into the surface.
TEST(Lift, KeepsReflectionsAboveTheSurface) {
  const Scene scene = sceneOf(mirrorMaterial(1));
  test::Numbers numbers(11);
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
      EXPECT_LT(length(r - mirrored), 1e-14);
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
  EXPECT_LT(length(raised(justBelow, up, just.y) - just), 1e-8);

  const Vec3d once = raised(normalized(Vec3d{1, -0.02, 0}), up, 0.01);
  EXPECT_LT(length(raised(once, up, 0.01) - once), 1e-5);
  const Vec3d flat = normalized(Vec3d{0.3, 0.4, 0.5});
  EXPECT_EQ(raised(flat, up, 0.01), flat) << "not a bit changes where nothing is to be done";
}

// Hard case H33: the view is behind the shading normal.
TEST(Lift, ViewBehindTheShadingNormal) {
  Material m = mirrorMaterial(0.5f);
  m.transmission = Rgb(1.0f);
  const Scene scene = sceneOf(m);
  const Surfel s = surfelSeen({-1, 0.1, 0}, {1, 0.5, 0});
  ASSERT_LT(dot(s.view, s.shadingNormal), 0);

  const Impulses found = impulsesOf(scene, s);
  EXPECT_TRUE(isFinite(found.reflected.ray.direction));
  EXPECT_GT(found.reflected.ray.direction.y, 0);
  EXPECT_NEAR(found.reflected.weight.x, 1, 1e-15) << "total reflection, coat or not";
  EXPECT_EQ(found.refracted.weight, RgbD());
}

TEST(MirrorFloor, ShowsTheSkyUpsideDown) {
  SceneBuilder builder;
  builder.add(test::floorAt(0, 100, builder.add(mirrorMaterial(0.5f))));

  Sky& sky = builder.description.sky;
  sky.kind = Sky::Kind::gradient;
  sky.zenith = {1, 2, 4};
  sky.horizon = {8, 4, 2};
  sky.ground = {99, 99, 99};
  const Scene scene = builder.build();

  test::Numbers numbers(12);
  for (int i = 0; i < 1000; ++i) {
    Vec3d d = numbers.direction();
    d.y = -std::abs(d.y) - 0.1;
    d = normalized(d);
    const RgbD expected = skyRadiance(scene.sky, {d.x, -d.y, d.z}) * 0.5;
    EXPECT_LT(length(radianceAlong(scene, {0, 1, 0}, d) - expected), 1e-13);
  }
}

// A closed box of glowing mirrors, whose radiance is a geometric series in the reflectance (hard
// case H62).
class HallOfMirrors : public ::testing::Test {
 protected:
  static Scene hall(float reflectance) {
    SceneBuilder builder;
    Material m = mirrorMaterial(reflectance);
    m.emission = Rgb(1.0f);
    builder.add(test::box({-1, -1, -1}, {1, 1, 1}, builder.add(m)));
    return builder.build();
  }
  const Vec3d eye_{0.1, 0.2, -0.3}, direction_{0.31, -0.2, 0.93};
};

TEST_F(HallOfMirrors, PerfectMirrorsCountTheDepth) {
  const Scene scene = hall(1);
  for (const int depth : {0, 1, 8, 64}) {
    RayCounts counts;
    const RgbD seen = radianceAlong(scene, eye_, direction_, test::uncut(depth), &counts);
    EXPECT_EQ(seen, RgbD(depth + 1.0));
    EXPECT_EQ(counts[RayKind::reflection], static_cast<std::uint64_t>(depth));
  }
}

TEST_F(HallOfMirrors, SumsTheSeries) {
  for (const float r : {0.5f, 0.9f}) {
    const Scene scene = hall(r);
    for (const int depth : {1, 8, 32}) {
      const RgbD seen = radianceAlong(scene, eye_, direction_, test::uncut(depth));
      EXPECT_NEAR(seen.x, (1 - std::pow(double{r}, depth + 1)) / (1 - double{r}), 1e-12);
    }
  }
}

// Hard case H64: impulses that contribute less than the cutoff are not traced, and the image loses
// no more than their contribution.
TEST_F(HallOfMirrors, CutoffStopsWhatNoLongerCounts) {
  const Scene scene = hall(0.5f);
  Settings settings = test::uncut(64);
  const auto seenWith = [&](float cutoff, std::uint64_t reflections) {
    settings.options.cutoff = cutoff;
    RayCounts counts;
    const double seen = radianceAlong(scene, eye_, direction_, settings, &counts).x;
    EXPECT_EQ(counts[RayKind::reflection], reflections) << cutoff;
    return seen;
  };

  EXPECT_EQ(seenWith(0.1f, 3), 1.875);
  EXPECT_EQ(seenWith(0.125, 3), 1.875) << "what contributes just the cutoff is traced";
  EXPECT_EQ(seenWith(0.126f, 2), 1.75);
  EXPECT_EQ(seenWith(2, 0), 1);
}

// Rays go towards edges and corners, but miss them by less than a float resolves (hard case H7). A
// ray exactly on an edge would be reflected from within the other wall, and would not hit it.
TEST_F(HallOfMirrors, CornersDoNotLeak) {
  const Scene scene = hall(1);
  for (const double inset : {1e-4, 1e-8, 1e-12}) {
    const double e = 1 - inset;
    for (const Vec3d& target : {Vec3d{1, 0, e}, Vec3d{-e, 0.3, -1}, Vec3d{0.2, 1, e},
                                Vec3d{1, e, 1 - 2 * inset}, Vec3d{-e, -1, -1 + 2 * inset}}) {
      EXPECT_EQ(radianceAlong(scene, {0, 0, 0}, target, test::uncut(8)), RgbD(9.0)) << inset;
    }
  }
}

TEST_F(HallOfMirrors, DisabledMirrorsReflectNothing) {
  Settings settings = test::uncut(8);
  settings.effects = EffectSet::all().without(Effect::mirror);
  RayCounts counts;
  EXPECT_EQ(radianceAlong(hall(1), eye_, direction_, settings, &counts), RgbD(1.0));
  EXPECT_EQ(counts[RayKind::reflection], 0u);
}

// A ray of throughput 0.25 has hit a mirror of reflectance 0.5 from straight above.
TEST(AddImpulsesReference, IsTheChildOfItsKind) {
  Material mirror = test::blackMaterial();
  mirror.mirror = mirror.mirrorGrazing = Rgb(0.5f);
  const Scene scene = sceneOf(mirror);
  test::SmallChunk small(scene);
  small.world.effects = EffectSet::all();

  Chunk& c = small.chunk;
  const std::size_t slot = 2;

  test::setRay(c.rays, slot, {0, 1, 0}, {0, -1, 0});
  c.rays.throughput[slot] = 0.25f;
  c.rays.path[slot] = 99;
  c.rays.media[slot] = 0;
  c.surfels.ng.y[slot] = c.surfels.ns.y[slot] = 1;
  c.surfels.cone[slot] = 0.125f;

  c.children.parent[0] = static_cast<std::uint32_t>(slot);
  c.children.path[0] = childStream(99, kMirroredBranch);
  c.childCount = c.childSegmentCount = 1;
  c.childSegments[0] = {RayKind::reflection, 0, 1};

  const RayRow mirrored = addImpulses(small.world, c, 0);
  EXPECT_EQ(mirrored.weight.y, 0.5);
  EXPECT_EQ(mirrored.throughput, 0.125);
  EXPECT_EQ(mirrored.dir.y, 1);
  EXPECT_EQ(mirrored.parent, slot);
  EXPECT_EQ(mirrored.cone, 0.125);
  EXPECT_EQ(mirrored.path, childStream(99, kMirroredBranch));

  // The material is no dielectric, so that nothing is refracted.
  c.childSegments[0].kind = RayKind::refraction;
  EXPECT_EQ(addImpulses(small.world, c, 0).weight.y, 0);
  EXPECT_EQ(addImpulses(small.world, c, 0).path, childStream(99, kRefractedBranch));
}

}  // namespace
}  // namespace whit::reference
