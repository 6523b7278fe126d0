// Refracted impulses, and surfaces that other dielectrics hide.
#include <gtest/gtest.h>

#include <cmath>

#include "reference/add_impulses.h"
#include "reference/fresnel.h"
#include "reference/small_scenes.h"

namespace whit::reference {
namespace {

using namespace test;

// Refracted rays reach the far side, whatever the shading normal is. Where they leave the glass,
// Snell's law about a tilted normal alone would leave some on the near side.
TEST(Energy, RefractedRaysGoThrough) {
  const Scene scene = withFloor(glassMaterial(1.5f)).build();
  Numbers numbers(15);
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

// A hidden surface shows neither its emission nor its coat.
TEST(Hidden, SurfacesAreNotThere) {
  SceneBuilder builder;
  Material inner = glassMaterial(1.33f);
  inner.emission = inner.mirror = inner.mirrorGrazing = Rgb(1.0f);
  addSlab(builder, 1, -1, glassMaterial(1, 1));
  addSlab(builder, 0.5f, -0.5f, inner);
  builder.sky(0.25f);

  RayCounts counts;
  const RgbD seen = radianceAlong(builder.build(), {0, 2, 0}, steep(30), uncut(), &counts);
  EXPECT_EQ(seen, RgbD(0.25));
  EXPECT_EQ(counts[RayKind::refraction], 4u);
  EXPECT_EQ(counts[RayKind::reflection], 0u);
}

TEST(Transmission, DisabledMeansOpaque) {
  SceneBuilder builder;
  addSlab(builder, 0, -1, glassMaterial(1.5f));
  builder.sky(1);
  const Scene scene = builder.build();

  RayCounts counts;
  EXPECT_EQ(radianceBelow(scene, {0, 1, 0}, without(Effect::transmission), &counts), RgbD());
  EXPECT_EQ(counts[RayKind::refraction] + counts[RayKind::reflection], 0u);
  EXPECT_NEAR(radianceBelow(scene, {0, 1, 0}, without(Effect::mirror)).x, 0.96 * 0.96, 1e-14)
      << "without reflections only the straight way";
}

}  // namespace
}  // namespace whit::reference
