// Spot and directional lights in the vector pipeline. Their closed forms are tests of the reference
// and of the oracle.
#include <gtest/gtest.h>

#include <algorithm>

#include "reference/small_scenes.h"
#include "render/pipeline_laws.h"

namespace whit::test {
namespace {

// The lights shine on a floor of albedo 0.5 that fills the picture.
Scene floorUnder(const std::vector<Light>& lights) {
  SceneBuilder builder = withFloor(diffuseMaterial(0.5f), 8);
  builder.description.lights = lights;
  builder.description.cameras = {lookingDown()};
  return builder.build();
}

// No shadow ray is traced from outside of a light's cone, nor where the surface faces away.
TEST(LightKinds, TraceShadowRaysWhereTheyShine) {
  for (const Light& light : {spotOf(15, 25), sun({3, -4, 0}, 3), sun({0, 1, 0}, 3)}) {
    const Picture picture = render(floorUnder({light}), smallOptions());
    const double lit = static_cast<double>(
        std::ranges::count_if(picture.image.pixels, [](const Rgb& p) { return p.x > 0; }));
    EXPECT_EQ(lit > 100, light.direction.y < 0);
    // At the edge of the cone, pixels may be lit by less than a float holds.
    EXPECT_NEAR(static_cast<double>(picture.stats.of(RayKind::shadow).rays), lit, 2);
  }
}

// Every stage agrees with the scalar reference on every target, and the picture with the reference.
TEST(LightKinds, AgreeWithTheReference) {
  const Scene scene = load("effects");
  expectStagesAgreeOnEveryTarget(scene, smallOptions());
  EXPECT_LE(differenceFromReference(scene, smallOptions()).pixelsGe2CodesPct, 0.1);
}

}  // namespace
}  // namespace whit::test
