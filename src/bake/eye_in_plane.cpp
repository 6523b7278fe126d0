#include "bake/eye_in_plane.h"

#include <algorithm>
#include <cmath>

#include "bake/sphere.h"

namespace whit {

namespace {

// Rounding of the eye's coordinates: at most four units in the last place of the largest.
double roundingOf(const Vec3d& eye) {
  const Vec3d size = abs(eye);
  return 0x1p-22 * (size.x + size.y + size.z);
}

}  // namespace

bool liesInPlane(const Vec3d& eye, const Corners& corners) {
  const Vec3d n = cross(corners[1] - corners[0], corners[2] - corners[0]);
  return std::fabs(dot(n, eye - corners[0])) <= roundingOf(eye) * length(n);
}

bool liesInSurface(const Scene& scene, const Vec3d& eye, std::uint32_t number,
                   std::uint32_t instance) {
  if (!scene.isSphere(number)) return liesInPlane(eye, worldCorners(scene, number, instance));
  Affine map = sphereMap(scene.triangles[number]);
  if (instance != kNoInstance) map = scene.instances[instance].toWorld * map;
  const Vec3d unit = onUnitSphere(map, eye), direction = normalized(unit);
  // Along the normal the map stretches by this.
  const double stretch = std::fabs(map.determinant()) / length(map.normal(direction));
  return std::fabs(length(unit) - 1) * stretch <= roundingOf(eye);
}

double wayPastEye(const Vec3d& eye, int attempt) {
  constexpr double kLeast = 1e-30;  // a product with it still is a float
  return std::ldexp(std::max(roundingOf(eye), kLeast), attempt);
}

}  // namespace whit
