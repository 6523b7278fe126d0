// Areas, volumes and edges of meshes, in double from the float corners.
#pragma once

#include <array>
#include <cstring>
#include <map>
#include <utility>

#include "core/index.h"
#include "scene/mesh.h"

namespace whit::test {

inline std::array<Vec3d, 3> corners(const Mesh& mesh, std::size_t t) {
  const auto& k = mesh.triangles[t];
  return {Vec3d(mesh.positions[k[0]]), Vec3d(mesh.positions[k[1]]), Vec3d(mesh.positions[k[2]])};
}

// Returns twice the triangle's area along its outward normal.
inline Vec3d areaVector(const Mesh& mesh, std::size_t t) {
  const auto [a, b, c] = corners(mesh, t);
  return cross(b - a, c - a);
}

inline double area(const Mesh& mesh) {
  double sum = 0;
  for (const auto t : indices(mesh.triangles)) sum += length(areaVector(mesh, t)) / 2;
  return sum;
}

// Uses the divergence theorem; the result is positive where the triangles face outwards.
inline double volume(const Mesh& mesh) {
  double sum = 0;
  for (const auto t : indices(mesh.triangles)) {
    const auto [a, b, c] = corners(mesh, t);
    sum += dot(a, cross(b, c)) / 6;
  }
  return sum;
}

using PositionBits = std::array<std::uint32_t, 3>;

inline PositionBits bits(const Vec3f& p) {
  PositionBits b{};
  std::memcpy(b.data(), &p, sizeof(b));
  return b;
}

struct EdgeUse {
  int triangles = 0, balance = 0;  // those that traverse it one way less those of the other way
};

// Returns the edges by the bits of their ends.
inline auto edgesOf(const Mesh& mesh) {
  std::map<std::pair<PositionBits, PositionBits>, EdgeUse> edges;
  for (const auto& t : mesh.triangles) {
    for (const auto k : indices(3)) {
      const PositionBits a = bits(mesh.positions[t[k]]), b = bits(mesh.positions[t[(k + 1) % 3]]);
      EdgeUse& use = edges[std::minmax(a, b)];
      ++use.triangles;
      use.balance += a < b ? 1 : -1;
    }
  }
  return edges;
}

}  // namespace whit::test
