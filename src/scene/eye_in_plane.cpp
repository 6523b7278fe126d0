#include "scene/eye_in_plane.h"

#include <algorithm>
#include <cmath>

namespace whit {

namespace {

// Of the eye's coordinates: four units in the last place of the largest at the most.
double roundingOf(const Vec3d& eye) {
  const Vec3d size = abs(eye);
  return 0x1p-22 * (size.x + size.y + size.z);
}

}  // namespace

bool liesInPlane(const Vec3d& eye, const Corners& corners) {
  const Vec3d n = cross(corners[1] - corners[0], corners[2] - corners[0]);
  return std::fabs(dot(n, eye - corners[0])) <= roundingOf(eye) * length(n);
}

double wayPastEye(const Vec3d& eye, int attempt) {
  constexpr double kLeast = 1e-30;  // a product with it still is a float
  return std::ldexp(std::max(roundingOf(eye), kLeast), attempt);
}

}  // namespace whit
