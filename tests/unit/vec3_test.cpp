#include "core/vec3.h"

#include <gtest/gtest.h>

#include <cmath>

namespace whit {
namespace {

// Three roundings: of the scaled vector's length, of the quotient and of the sum of squares.
constexpr double kUnitTolerance = 3 * 0x1p-24;

// H51: the squares may overflow or underflow, but the result must not show it.
TEST(Normalized, UnitLengthFromTheSmallestToTheLargestFloat) {
  double worst = 0;
  for (int k = -44; k <= 38; ++k) {
    const float s = std::pow(10.0f, static_cast<float>(k));
    for (const Vec3f& v : {Vec3f{s, 2 * s, -2 * s}, Vec3f{s, 0, 0}, Vec3f{s, s, s}}) {
      const Vec3f n = normalized(v);
      if (!isFinite(v)) continue;  // 2e38 has no float
      worst = std::max(worst, std::abs(length(Vec3d(n)) - 1));
      EXPECT_GT(n.x, 0) << "10^" << k;
    }
  }
  EXPECT_LE(worst, kUnitTolerance);
}

TEST(Normalized, PowersOfTwoLeaveTheBitsAlone) {
  const Vec3f v{0.3f, -0.7f, 0.11f}, n = normalized(v);
  for (int k = -100; k <= 120; ++k) {
    EXPECT_EQ(normalized(v * std::ldexp(1.0f, k)), n) << "2^" << k;
  }
}

TEST(Normalized, FallsBackWhereThereIsNoDirection) {
  const Vec3f fallback{0, 0, 1};
  for (const Vec3f& v : {Vec3f{}, {1, NAN, 0}, {NAN, 1, 0}, {1, INFINITY, 0}}) {
    EXPECT_EQ(normalized(v, fallback), fallback) << v.x << " " << v.y;
  }
  EXPECT_EQ(normalized(Vec3f{}), Vec3f{});
}

}  // namespace
}  // namespace whit
