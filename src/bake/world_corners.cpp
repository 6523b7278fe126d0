#include "bake/world_corners.h"

namespace whit {

Corners cornersOf(const TriangleRecord& triangle, const Affine* toWorld) {
  const float* p = triangle.position;
  Corners corners{Vec3d(p[0], p[1], p[2]), Vec3d(p[3], p[4], p[5]), Vec3d(p[6], p[7], p[8])};
  if (!toWorld) return corners;
  for (Vec3d& corner : corners) corner = toWorld->point(corner);
  return corners;
}

Corners worldCorners(const Scene& scene, std::uint32_t triangle, std::uint32_t instance) {
  const bool carried = instance != kNoInstance;
  return cornersOf(scene.triangles[triangle],
                   carried ? &scene.instances[instance].toWorld : nullptr);
}

}  // namespace whit
