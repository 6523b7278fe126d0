// Rays from inside a closed body exactly or nearly through its edges and corners.
#pragma once

#include "stress/bodies.h"

namespace whit::stress {

// A point well inside the sphere.
inline Vec3f inside(Numbers& numbers, const Vec3d& center, double radius) {
  return Vec3f(center + numbers.direction() * (0.5 * radius));
}

// Towards the middle of every edge, from inside.
inline std::vector<ProbeRay> throughEdges(const Mesh& mesh, const Vec3d& center, double radius) {
  Numbers numbers(13);
  std::vector<ProbeRay> rays;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d a(mesh.positions[triangle[i]]), b(mesh.positions[triangle[(i + 1) % 3]]);
      rays.push_back(rayThrough(inside(numbers, center, radius), Vec3f((a + b) * 0.5)));
    }
  }
  return rays;
}

// Exactly: from the origin the target is the direction.
inline ProbeRay exactlyThrough(const Vec3f& target) { return {{0, 0, 0}, target}; }

// Towards every corner: the first time exactly, then from inside.
inline std::vector<ProbeRay> throughCorners(const Mesh& mesh, const Vec3d& center, double radius,
                                            int times) {
  Numbers numbers(14);
  std::vector<ProbeRay> rays;
  for (int k = 0; k < times; ++k) {
    for (const Vec3f& corner : mesh.positions) {
      rays.push_back(k == 0 ? exactlyThrough(corner)
                            : rayThrough(inside(numbers, center, radius), corner));
    }
  }
  return rays;
}

}  // namespace whit::stress
