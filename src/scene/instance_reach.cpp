#include "scene/instance_reach.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/scene.h"

namespace whit {

float instanceReach(const Affine& toWorld) {
  // Far from where products of three floats lose bits or leave their range.
  constexpr double kSmallest = 1e-35, kLargest = 1e35;
  const double determinant = std::abs(toWorld.determinant());
  if (!(determinant >= kSmallest && determinant <= kLargest)) return 0;
  const std::array<Vec3d, 3> adjoint{cross(toWorld.y, toWorld.z), cross(toWorld.z, toWorld.x),
                                     cross(toWorld.x, toWorld.y)};
  double stretch = 0, shift = 0;
  for (const Vec3d& row : adjoint) {
    const Vec3d size = abs(row);
    if (!(maxComponent(size) <= kLargest)) return 0;
    stretch = std::max(stretch, (size.x + size.y + size.z) / determinant);
    shift = std::max(shift, dot(size, abs(toWorld.p)) / determinant);
  }
  // Half of the range is for the rounding of all this.
  const double room = 0.5 * kLargestCoordinate - shift;
  return room > 0 ? static_cast<float>(std::min<double>(room / stretch, kLargestCoordinate)) : 0.0f;
}

}  // namespace whit
