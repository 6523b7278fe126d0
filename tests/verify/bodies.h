// Closed bodies and rays onto them.
#pragma once

#include "make/shapes/mesh_builder.h"
#include "verify/probe.h"
#include "verify/scene_builder.h"

namespace whit::verify {

// A subdivided icosahedron with corners rounded to float, and the sphere's normals if smooth.
inline Mesh sphereMesh(int level, const Vec3d& center, double radius, std::uint32_t material = 0,
                       bool smooth = false) {
  const auto [points, triangles] = procedural::icosphereMesh(level);

  Mesh mesh;
  for (const Vec3d& p : points) {
    mesh.positions.emplace_back(center + p * radius);
    if (smooth) mesh.normals.emplace_back(p);
  }

  mesh.triangles = triangles;
  mesh.materials = {material};
  return mesh;
}

// The same mesh without shared corners.
inline Mesh unshared(const Mesh& mesh) {
  Mesh result;
  result.materials = mesh.materials;
  for (const auto& [a, b, c] : mesh.triangles) {
    addTriangle(result, {mesh.positions[a], mesh.positions[b], mesh.positions[c]});
  }
  return result;
}

// The plane y = 0 between -32 and 32, in 64 x 64 cells.
inline Mesh grid() {
  return sheetOf(65, 65, [](int x, int y) { return Vec3f(Vec3d(x - 32, 0, y - 32)); });
}

inline ProbeRay rayThrough(const Vec3f& origin, const Vec3f& target) {
  return {origin, Vec3f(normalized(Vec3d(target) - Vec3d(origin)))};
}

// `n` rays, each made by make(numbers, number of the ray).
template <typename Make>
std::vector<ProbeRay> randomRays(int n, std::uint64_t seed, const Make& make) {
  Numbers numbers(seed);
  std::vector<ProbeRay> rays;
  for (int i = 0; i < n; ++i) rays.push_back(make(numbers, i));
  return rays;
}

// Rays from all around, at three radii from the center, through the inside of the sphere.
inline std::vector<ProbeRay> raysOnto(const Vec3d& center, double radius, int n,
                                      std::uint64_t seed) {
  return randomRays(n, seed, [&](Numbers& numbers, int) {
    const Vec3f from(center + numbers.direction() * (3 * radius));
    return rayThrough(from, Vec3f(center + numbers.direction() * (0.95 * radius)));
  });
}

}  // namespace whit::verify
