#pragma once

#include <gtest/gtest.h>

#include "core/vec3.h"

namespace whit {

// Upper bound on the rounding error of formulas in double, for values up to a few hundred.
inline constexpr double kRounding = 1e-12;

// Expects points, directions or colors to be as near to each other as this.
inline void expectNear(const Vec3d& got, const Vec3d& wanted, double tolerance = kRounding) {
  EXPECT_LE(length(got - wanted), tolerance) << got.x << ' ' << got.y << ' ' << got.z << " against "
                                             << wanted.x << ' ' << wanted.y << ' ' << wanted.z;
}

}  // namespace whit
