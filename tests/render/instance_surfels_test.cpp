// What a surface takes from the transform of its instance: how far rays start from it, and its
// normals.
#include <gtest/gtest.h>

#include <functional>

#include "reference/small_scenes.h"
#include "render/kernel_surfels.h"
#include "rounding.h"

namespace whit::test {
namespace {

// Returns a square that is placed twice, the first time by this map.
Scene placed(const Affine& map, float height, float half) {
  SceneBuilder builder;
  const Mesh mesh = floorAt(height, half, builder.add(diffuseMaterial(0.5f)));
  builder.place({"floor", {mesh}}, {map, Affine()});
  Scene scene = builder.build();
  EXPECT_EQ(scene.instances.size(), 2u);
  return scene;
}

// Interpolates a hit on the first triangle of the first instance on each target.
void interpolateOnEveryTarget(
    const Scene& scene, const Vec3f& direction,
    const std::function<void(const SurfelColumns&, const SurfelRow&)>& check) {
  forEachTarget([&](const std::string& target) {
    KernelSurfels kernel(scene, target);
    kernel.hit(0, 0, direction, 0, 0);
    kernel.interpolate();
    check(kernel.chunk().surfels, kernel.scalar(0));
  });
}

// The offset is 32 u times the magnitudes that make up the point (|x| + |y| + |z| of the corner,
// scaled by 2, and the translation), and 16 u times the two edges, 4 and 4 + 4 long by axes, scaled
// by 2.
TEST(InstanceOffset, GrowsWithTheTranslationInBothPaths) {
  for (const double far : {0.0, 1.0, 1e3, 1e6}) {
    const Scene scene =
        placed(Affine::translation({far, -far, 0.5 * far}) * Affine::scaling(Vec3d(2)), 3, 2);
    const double wanted = 0x1p-19 * (2 * (2 + 3 + 2) + 2.5 * far) + 0x1p-20 * 2 * (4 + 4 + 4);
    interpolateOnEveryTarget(scene, {0, -1, 0},
                             [&](const SurfelColumns& vector, const SurfelRow& scalar) {
                               // A dozen sums of nonnegative numbers are rounded.
                               EXPECT_NEAR(vector.offset[0], wanted, 12 * 0x1p-24 * wanted) << far;
                               EXPECT_NEAR(scalar.offset, wanted, 1e-15 * wanted) << far;
                             });
  }
}

// Cofactors are of the order of the scale's square, and the square of a cofactor exceeds the range
// of floats.
TEST(InstanceNormals, TurnWithTheInstanceWhateverItsScale) {
  const Affine turn = Affine::rotation({1, 2, 3}, 40);
  const Vec3d wanted = turn.normal({0, 1, 0});
  for (const double scale : {1.0, 1e-6, 1e-9, 1e-11, 1e9, 1e11}) {
    SCOPED_TRACE(scale);
    interpolateOnEveryTarget(placed(turn * Affine::scaling(Vec3d(scale)), 0, 1), Vec3f(-wanted),
                             [&](const SurfelColumns& vector, const SurfelRow& scalar) {
                               expectNear(Vec3d(vector.ng.at(0)), wanted, 1e-6);
                               expectNear(Vec3d(vector.ns.at(0)), wanted, 1e-6);
                               expectNear(Vec3d(scalar.ns), wanted, 1e-6);
                             });
  }
}

}  // namespace
}  // namespace whit::test
