#include "sampling/cosine_lobe.h"

#include <cmath>
#include <numbers>

namespace whit {

Vec3d cosineDirection(const Vec3d& normal, const UnitPoint& at) {
  const Vec3d axis = std::fabs(normal.x) < double{kFrameAlongY} ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  const Vec3d x = normalized(cross(normal, axis)), y = cross(normal, x);
  const double turn = 2 * std::numbers::pi * double{at.u}, sine2 = double{at.v};
  const double sine = std::sqrt(sine2), cosine = std::sqrt(1 - sine2);
  return normalized(x * (sine * std::cos(turn)) + y * (sine * std::sin(turn)) + normal * cosine);
}

}  // namespace whit
