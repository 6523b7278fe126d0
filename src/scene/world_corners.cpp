#include "scene/world_corners.h"

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

Corners worldCorners(const Scene& scene, std::uint32_t triangle, std::uint32_t instance) {
  const float* p = scene.triangles[triangle].position;
  Corners corners{Vec3d(p[0], p[1], p[2]), Vec3d(p[3], p[4], p[5]), Vec3d(p[6], p[7], p[8])};
  if (instance != kNoInstance) {
    for (Vec3d& corner : corners) corner = scene.instances[instance].toWorld.point(corner);
  }
  return corners;
}

bool liesInPlane(const Vec3d& eye, const Corners& corners) {
  const Vec3d n = cross(corners[1] - corners[0], corners[2] - corners[0]);
  return std::fabs(dot(n, eye - corners[0])) <= roundingOf(eye) * length(n);
}

double wayPastEye(const Vec3d& eye, int attempt) {
  constexpr double kLeast = 1e-30;  // a product with it still is a float
  return std::ldexp(std::max(roundingOf(eye), kLeast), attempt);
}

}  // namespace whit
