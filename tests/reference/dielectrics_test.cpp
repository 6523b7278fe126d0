// Refracted impulses through slabs and stacks of slabs (hard cases H10, H38, H42, H44, H45).
#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "reference/add_impulses.h"
#include "reference/find_intersections.h"
#include "reference/fresnel.h"
#include "reference/small_scenes.h"

namespace whit::reference {
namespace {

using test::addSlab;
using test::glassMaterial;
using test::radianceAlong;
using test::SceneBuilder;
using test::steep;

// The refracted ray that was followed until it left the scene.
struct StraightThrough {
  Ray last;
  MediaStack media = 0;
  int hits = 0, hidden = 0;
  std::vector<double> reflectances;  // at surfaces that are not hidden
};
StraightThrough followRefracted(const Scene& scene, const Vec3d& origin, const Vec3d& direction) {
  StraightThrough path;
  path.last = {origin, normalized(direction)};
  const BruteForce bruteForce(scene);
  Candidate candidate;
  while (path.hits < 20 && bruteForce.closest(path.last, candidate)) {
    ++path.hits;
    const TriangleHit hit = refineHit(scene, path.last, candidate);
    const Surfel s = makeSurfel(scene, EffectSet::all(), candidate, hit, path.last);

    const Crossing crossing =
        crossMedia(scene, EffectSet::all(), s.material, s.entering, path.media);
    const Impulses found = findImpulses(scene, EffectSet::all(), s, crossing, path.media);

    path.hidden += crossing.hidden;
    if (!crossing.hidden) path.reflectances.push_back(found.reflected.weight.x);
    path.last = found.refracted.ray;
    path.media = found.refracted.media;
  }
  return path;
}

// Returns the distance of the path's last ray from the straight line in the plane y = 0.
double lateralShift(const StraightThrough& path, const Vec3d& origin, const Vec3d& direction) {
  const auto across = [](const Vec3d& o, const Vec3d& d) { return o - d * (o.y / d.y); };
  const Vec3d there = across(path.last.origin, path.last.direction) - across(origin, direction);
  return length(there - direction * dot(there, direction));
}

// At each of up to four faces the origin moves by offset = 32 u (|x| + |y| + |z|) of the
// interpolated magnitudes, which are at most 5 + 2 + 5 here.
constexpr double kOffsetsOfFourFaces = 4 * 32 * 12 / 16777216.0;

TEST(Slab, ShiftsAndKeepsTheDirection) {
  SceneBuilder builder;
  addSlab(builder, 0, -1, builder.add(glassMaterial(1.5f)), 4);
  const Vec3d d = steep(60), origin = Vec3d{0, 0, 0} - d * 3.0;

  const StraightThrough path = followRefracted(builder.build(), origin, d);
  EXPECT_EQ(path.hits, 2);
  EXPECT_EQ(path.media, 0u);
  EXPECT_LT(length(path.last.direction - d), 1e-14);
  EXPECT_NEAR(lateralShift(path, origin, d), 0.512472013, kOffsetsOfFourFaces);

  ASSERT_EQ(path.reflectances.size(), 2u);
  EXPECT_NEAR(path.reflectances[0], path.reflectances[1], 1e-14) << "reciprocity";
}

// A path through plane layers keeps n sin, so that the shift is the sum over the layers.
double shiftThrough(double degrees, const std::vector<std::pair<double, double>>& layers) {
  const double angle = degrees * kPi / 180;
  double shift = 0;
  for (const auto& [ior, thickness] : layers) {
    const double inside = std::asin(std::sin(angle) / ior);
    shift += thickness * std::sin(angle - inside) / std::cos(inside);
  }
  return shift;
}

class NestedTest : public ::testing::Test {
 protected:
  // The glass reaches from 0 to -1 and the water from `waterTop` to -2.
  StraightThrough path(float waterTop, int glassPriority, int waterPriority) {
    SceneBuilder builder;
    const auto glass = builder.add(glassMaterial(1.5f, glassPriority));
    const auto water = builder.add(glassMaterial(1.33f, waterPriority));
    addSlab(builder, 0, -1, glass, 5);
    addSlab(builder, waterTop, -2, water, 5);
    return followRefracted(builder.build(), origin_, direction_);
  }
  static constexpr double kAngle = 40;
  const Vec3d direction_ = steep(kAngle), origin_ = -direction_;
};

TEST_F(NestedTest, OverlapActsAsOneInterface) {
  const StraightThrough seen = path(-0.999f, 1, 0);
  EXPECT_EQ(seen.hits, 4);
  EXPECT_EQ(seen.hidden, 1);
  EXPECT_EQ(seen.media, 0u);
  EXPECT_LT(length(seen.last.direction - direction_), 1e-14);
  EXPECT_NEAR(lateralShift(seen, origin_, direction_),
              shiftThrough(kAngle, {{1.5f, 1}, {1.33f, 1}}), kOffsetsOfFourFaces);

  // The middle interface is that of glass into water, with ratio 0.8867.
  const double inGlass = std::sqrt(1 - std::pow(std::sin(kAngle * kPi / 180) / 1.5, 2));
  ASSERT_EQ(seen.reflectances.size(), 3u);
  EXPECT_NEAR(seen.reflectances[1], makeInterface(1.5f, 1.33f, inGlass).reflectance, 1e-12);
}

TEST_F(NestedTest, WaterMayOutrankGlass) {
  const StraightThrough seen = path(-0.75f, 0, 1);
  EXPECT_EQ(seen.hidden, 1);
  EXPECT_EQ(seen.media, 0u);
  EXPECT_NEAR(lateralShift(seen, origin_, direction_),
              shiftThrough(kAngle, {{1.5f, 0.75}, {1.33f, 1.25}}), kOffsetsOfFourFaces);
}

TEST_F(NestedTest, GapHoldsVacuum) {
  const StraightThrough seen = path(-1.25f, 0, 0);
  EXPECT_EQ(seen.hidden, 0);
  EXPECT_EQ(seen.reflectances.size(), 4u);
  EXPECT_LT(length(seen.last.direction - direction_), 1e-14);
  EXPECT_NEAR(lateralShift(seen, origin_, direction_),
              shiftThrough(kAngle, {{1.5f, 1}, {1.33f, 0.75}}), kOffsetsOfFourFaces);
}

// Hard case H44, up to the rounding of one sum.
TEST(Energy, ReflectedAndRefractedAddUpToOne) {
  SceneBuilder builder;
  builder.add(test::floorAt(0, 1, builder.add(glassMaterial(1.5f))));

  const Scene scene = builder.build();
  test::Numbers numbers(14);
  for (int i = 0; i < 10000; ++i) {
    Surfel s;
    s.geometricNormal = s.shadingNormal = numbers.direction();
    s.view = numbers.direction();
    if (dot(s.view, s.geometricNormal) < 0) s.view = -s.view;
    s.entering = i % 2;

    const MediaStack stack = s.entering ? 0 : 1;
    const Crossing crossing = crossMedia(scene, EffectSet::all(), 0, s.entering, stack);
    const Impulses found = findImpulses(scene, EffectSet::all(), s, crossing, stack);
    const double reflected = found.reflected.weight.x, refracted = found.refracted.weight.x;
    EXPECT_TRUE(reflected >= 0 && refracted >= 0);
    EXPECT_NEAR(reflected + refracted, 1, 2.3e-16);
  }
}

// Refracted rays reach the far side, whatever the shading normal is. Where they leave the glass,
// Snell's law about a tilted normal alone would leave some on the near side.
TEST(Energy, RefractedRaysGoThrough) {
  SceneBuilder builder;
  builder.add(test::floorAt(0, 1, builder.add(glassMaterial(1.5f))));
  const Scene scene = builder.build();
  test::Numbers numbers(15);
  int turnedBack = 0;
  for (int i = 0; i < 20000; ++i) {
    Surfel s;
    s.geometricNormal = {0, 1, 0};
    s.view = numbers.direction();
    s.view.y = std::abs(s.view.y);
    s.shadingNormal = normalized(numbers.direction() + Vec3d{0, 1, 0}, {0, 1, 0});
    s.entering = i % 2;

    const MediaStack stack = s.entering ? 0 : 1;
    const Crossing crossing = crossMedia(scene, EffectSet::all(), 0, s.entering, stack);
    const Impulses found = findImpulses(scene, EffectSet::all(), s, crossing, stack);
    if (!(maxComponent(found.refracted.weight) > 0)) continue;

    const Vec3d& r = found.refracted.ray.direction;
    EXPECT_LT(r.y, 0);
    EXPECT_NEAR(length(r), 1, 1e-14);

    const double c = dot(s.view, s.shadingNormal);
    const Interface interface = makeInterface(crossing.n1, crossing.n2, c);
    turnedBack += refract(interface, -s.view, s.shadingNormal, c).y >= 0;
  }
  EXPECT_GT(turnedBack, 100) << "the sweep was meant to reach the case";
}

// Hard case H38: glass with the vacuum's index is invisible, bit for bit.
TEST(IndexOne, IsInvisible) {
  SceneBuilder builder;
  builder.add(test::box({-1, -1, -1}, {1, 1, 1}, builder.add(glassMaterial(1))));
  Sky& sky = builder.description.sky;
  sky.kind = Sky::Kind::gradient;
  sky.zenith = {1, 2, 3};
  sky.horizon = {4, 5, 6};
  sky.ground = {7, 8, 9};

  const Scene scene = builder.build();
  test::Numbers numbers(16);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d eye = numbers.direction() * 4.0;
    const Vec3d towards = numbers.direction() - eye;
    RayCounts counts;
    EXPECT_EQ(radianceAlong(scene, eye, towards, test::uncut(), &counts),
              skyRadiance(scene.sky, normalized(towards)));
    EXPECT_EQ(counts[RayKind::reflection], 0u);
  }
}

// A hidden surface shows neither its emission nor its coat.
TEST(Hidden, SurfacesAreNotThere) {
  SceneBuilder builder;
  Material inner = glassMaterial(1.33f);
  inner.emission = inner.mirror = inner.mirrorGrazing = Rgb(1.0f);
  const auto outside = builder.add(glassMaterial(1, 1));
  const auto inside = builder.add(inner);
  addSlab(builder, 1, -1, outside);
  addSlab(builder, 0.5f, -0.5f, inside);
  builder.sky(0.25f);

  RayCounts counts;
  const RgbD seen = radianceAlong(builder.build(), {0, 2, 0}, steep(30), test::uncut(), &counts);
  EXPECT_EQ(seen, RgbD(0.25));
  EXPECT_EQ(counts[RayKind::refraction], 4u);
  EXPECT_EQ(counts[RayKind::reflection], 0u);
}

TEST(Transmission, DisabledMeansOpaque) {
  SceneBuilder builder;
  addSlab(builder, 0, -1, builder.add(glassMaterial(1.5f)));
  builder.sky(1);
  const Scene scene = builder.build();
  Settings settings = test::uncut();
  settings.effects = EffectSet::all().without(Effect::transmission);

  RayCounts counts;
  EXPECT_EQ(radianceAlong(scene, {0, 1, 0}, {0, -1, 0}, settings, &counts), RgbD());
  EXPECT_EQ(counts[RayKind::refraction] + counts[RayKind::reflection], 0u);

  settings.effects = EffectSet::all().without(Effect::mirror);
  const double transmitted = radianceAlong(scene, {0, 1, 0}, {0, -1, 0}, settings).x;
  EXPECT_NEAR(transmitted, 0.96 * 0.96, 1e-14) << "without reflections only the straight way";
}

}  // namespace
}  // namespace whit::reference
