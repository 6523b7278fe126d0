// The sum over the lights.
#include "reference/add_shading.h"

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

TEST(Lights, AddUpAndKeepTheirColors) {
  SceneBuilder builder;
  Material m = test::diffuseMaterial(1);
  m.diffuse = {1, 0.5f, 0.25f};
  builder.add(test::floorAt(0, 10, builder.add(m)));
  builder.description.lights = {lightAt({0, 2, 0}, 4), lightAt({0, 3, 0}, 9)};
  builder.description.lights[1].intensity = {0, 9, 18};

  const RgbD seen = radianceAlong(builder.build(), {0, 1, 0}, {0, -1, 0});
  EXPECT_NEAR(seen.x, 1 / kPi, 1e-12);
  EXPECT_NEAR(seen.y, 0.5 / kPi * 2, 1e-12);
  EXPECT_NEAR(seen.z, 0.25 / kPi * 3, 1e-12);
}

TEST(AddShadingReference, AddsWhatIsVisible) {
  const Scene scene = SceneBuilder().build();
  test::SmallChunk small(scene);
  small.chunk.unshadowed.rgb.x[0] = 0.5f;
  small.chunk.unshadowed.rgb.z[0] = 0x1p-30f;

  const RadianceRow before{Vec3d(1, 2, 3)};
  EXPECT_EQ(addShading(before, small.chunk, 0).rgb.x, 1);
  small.chunk.unshadowed.visible[0] = 1;

  const RadianceRow after = addShading(before, small.chunk, 0);
  EXPECT_EQ(after.rgb.x, 1.5);
  EXPECT_EQ(after.rgb.y, 2);
  EXPECT_EQ(after.rgb.z, 3 + 0x1p-30) << "in double";
}

}  // namespace
}  // namespace whit::reference
