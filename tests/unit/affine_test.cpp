#include "core/affine.h"

#include <gtest/gtest.h>

namespace whit {
namespace {

constexpr double kUnitRoundOff = 0x1p-53;

// Hard case H77. An entry of a product of two rotations takes 3 products and 2 sums, gamma(3), and
// the entries have a few roundings of sine, cosine and axis: gamma(8) a step covers both.
TEST(Affine, HundredNestedRotationsUndone) {
  Affine there, back;
  for (int i = 0; i < 100; ++i) {
    const Vec3d axis{std::sin(i * 1.0), std::cos(i * 2.0), 0.3};
    const double degrees = 7.0 + 13.0 * i;
    there = Affine::rotation(axis, degrees) * there;
    back = back * Affine::rotation(axis, -degrees);
  }

  const Vec3d p{0.3, -0.9, 0.2};
  const double error = length(back.point(there.point(p)) - p);
  EXPECT_LE(error, 200 * 8 * kUnitRoundOff);
  EXPECT_NEAR(there.determinant(), 1, 200 * 8 * kUnitRoundOff);
}

TEST(Affine, NormalsStayAcrossTheirSurface) {
  const Vec3d t1{1, 2, 0.5}, t2{-0.3, 1, 4}, n = cross(t1, t2);
  for (const Affine& map : {Affine::scaling({1e-3, 1, 1e3}), Affine::scaling({-2, 1, 1}),
                            Affine::rotation({1, 1, 0}, 40) * Affine::scaling({1, 5, 0.1})}) {
    const Vec3d mapped = normalized(map.normal(n));
    EXPECT_NEAR(dot(mapped, normalized(map.vector(t1))), 0, 1e-15);
    EXPECT_NEAR(dot(mapped, normalized(map.vector(t2))), 0, 1e-15);

    // A vector off the surface stays on the normal's side.
    EXPECT_GT(dot(mapped, map.vector(n)), 0);
  }
}

TEST(Affine, NormalOfASingularMap) {
  const Affine flat = Affine::scaling({1, 0, 1});
  EXPECT_EQ(flat.determinant(), 0);
  EXPECT_EQ(flat.normal({0, 1, 0}), (Vec3d{0, 1, 0}));  // the plane it flattens into
  EXPECT_EQ(flat.normal({1, 0, 0}), Vec3d{});           // a surface that becomes a line
}

}  // namespace
}  // namespace whit
