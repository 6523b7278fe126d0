// Areas, volumes and edges of meshes, in double from the float corners.
#pragma once

#include <array>
#include <cstring>
#include <map>
#include <utility>

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
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) sum += length(areaVector(mesh, t)) / 2;
  return sum;
}

// Uses the divergence theorem; the result is positive where the triangles face outwards.
inline double volume(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
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

// Counts the edges, by the bits of their ends, that triangles do not traverse equally often in both
// directions. A closed mesh has none, and neither has one whose solids touch along an edge.
inline std::size_t openEdges(const Mesh& mesh) {
  std::map<std::pair<PositionBits, PositionBits>, int> balance;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const PositionBits a = bits(mesh.positions[t[k]]), b = bits(mesh.positions[t[(k + 1) % 3]]);
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }

  std::size_t open = 0;
  for (const auto& [edge, count] : balance) open += count != 0;
  return open;
}

// Counts the edges that are not shared by exactly two triangles.
inline std::size_t unpairedEdges(const Mesh& mesh) {
  std::map<std::pair<PositionBits, PositionBits>, int> uses;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      ++uses[std::minmax(bits(mesh.positions[t[k]]), bits(mesh.positions[t[(k + 1) % 3]]))];
    }
  }

  std::size_t unpaired = 0;
  for (const auto& [edge, count] : uses) unpaired += count != 2;
  return unpaired;
}

}  // namespace whit::test
