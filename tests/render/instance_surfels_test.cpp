// What a surface takes from the transform of its instance: how far rays start from it, and its
// normals.
#include <gtest/gtest.h>

#include "reference/small_scenes.h"
#include "render/kernel_surfels.h"

namespace whit::test {
namespace {

// The offset is 32 u times the magnitudes that make up the point (|x| + |y| + |z| of the corner,
// scaled by 2, and the translation), and 16 u times the two edges, 4 and 4 + 4 long by axes, scaled
// by 2.
TEST(InstanceOffset, GrowsWithTheTranslationInBothPaths) {
  for (const double far : {0.0, 1.0, 1e3, 1e6}) {
    SceneBuilder builder;
    const Mesh mesh = floorAt(3, 2, builder.add(diffuseMaterial(0.5f)));
    const Affine carried = Affine::translation({far, -far, 0.5 * far}) * Affine::scaling(Vec3d(2));
    builder.place({"floor", {mesh}}, {carried, Affine()});
    const Scene scene = builder.build();

    ASSERT_EQ(scene.instances.size(), 2u);
    const double wanted = 0x1p-19 * (2 * (2 + 3 + 2) + 2.5 * far) + 0x1p-20 * 2 * (4 + 4 + 4);
    for (const std::string& target : simd::availableTargets()) {
      KernelSurfels kernel(scene, target);
      kernel.hit(0, 0, {0, -1, 0}, 0, 0);
      kernel.interpolate();

      // A dozen sums of nonnegative numbers are rounded.
      const double rounding = 12 * 0x1p-24 * wanted;
      EXPECT_NEAR(static_cast<double>(kernel.chunk().surfels.offset[0]), wanted, rounding)
          << target << " " << far;
      EXPECT_NEAR(kernel.scalar(0).offset, wanted, 1e-15 * wanted) << far;
    }
  }
  simd::chooseTarget("auto");
}

// Cofactors are of the order of the scale's square, and the square of a cofactor exceeds the range
// of floats.
TEST(InstanceNormals, TurnWithTheInstanceWhateverItsScale) {
  const Affine turn = Affine::rotation({1, 2, 3}, 40);
  const Vec3d wanted = turn.normal({0, 1, 0});
  for (const double scale : {1.0, 1e-6, 1e-9, 1e-11, 1e9, 1e11}) {
    SceneBuilder builder;
    const Mesh mesh = floorAt(0, 1, builder.add(diffuseMaterial(0.5f)));
    builder.place({"floor", {mesh}}, {turn * Affine::scaling(Vec3d(scale)), Affine()});
    const Scene scene = builder.build();

    ASSERT_EQ(scene.instances.size(), 2u);

    for (const std::string& target : simd::availableTargets()) {
      KernelSurfels kernel(scene, target);
      kernel.hit(0, 0, Vec3f(-wanted), 0, 0);
      kernel.interpolate();
      const SurfelColumns& s = kernel.chunk().surfels;
      const Vec3d ng(s.ng.at(0)), ns(s.ns.at(0));
      EXPECT_LE(length(ng - wanted), 1e-6) << target << " " << scale;
      EXPECT_LE(length(ns - wanted), 1e-6) << target << " " << scale;

      const SurfelRow scalar = kernel.scalar(0);
      EXPECT_LE(length(Vec3d(scalar.ns) - wanted), 1e-6) << scale;
    }
  }
  simd::chooseTarget("auto");
}

}  // namespace
}  // namespace whit::test
