// Directions about a normal, drawn by their cosine to it: all that a diffuse surface sees along
// them counts the same.
#pragma once

#include <cmath>
#include <numbers>

#include "core/vec3.h"
#include "sampling/random_streams.h"

namespace whit {

// The frame about a normal begins with the x axis, or where the normal's own x is this large or
// larger with the y axis. Normals that differ by rounding have to get directions that differ by no
// more: few surfaces are turned by just this.
inline constexpr float kFrameAlongY = 0.55f;

// The unit direction at `at`, of density cosine / pi by solid angle (Malley's method: Pharr, Jakob
// and Humphreys 2023, "Physically Based Rendering", section A.5.3). Never in the plane of the unit
// normal: its cosine is 2^-12 at least.
inline Vec3d cosineDirection(const Vec3d& normal, const UnitPoint& at) {
  const Vec3d axis = std::fabs(normal.x) < double{kFrameAlongY} ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  const Vec3d x = normalized(cross(normal, axis)), y = cross(normal, x);
  const double turn = 2 * std::numbers::pi * double{at.u}, sine2 = double{at.v};
  const double sine = std::sqrt(sine2), cosine = std::sqrt(1 - sine2);
  return normalized(x * (sine * std::cos(turn)) + y * (sine * std::sin(turn)) + normal * cosine);
}

}  // namespace whit
