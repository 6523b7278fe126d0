// Polygons in space, and strips and fans of triangles, as triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.h"

namespace whit {

using CornerTriple = std::array<std::uint32_t, 3>;

// Beyond this many corners only a fan is tried: clipping ears takes up to the cube of it.
inline constexpr std::size_t kEarCornerLimit = 512;

// Appends the triangles of the simple polygon `corners` (at least 3) to `triangles`, in its sense
// of rotation, as indices into `corners`: a quad along its shorter inner diagonal, others by
// clipping ears (Meisters 1975, "Polygons have ears") in the plane of Newell's normal. Returns
// false where that was not possible (most crossing edges, no plane, too many corners of a concave
// polygon) and a fan was made instead. Quads always have an answer.
bool triangulate(const std::vector<Vec3d>& corners, std::vector<CornerTriple>& triangles);

// Strips and fans join their parts by triangles that have a corner twice, which are left out.
inline void addJoined(const CornerTriple& corners, std::vector<CornerTriple>& to) {
  const auto& [a, b, c] = corners;
  if (a != b && b != c && c != a) to.push_back(corners);
}

// Turns every other triangle round, so that all face the same side.
inline void addStrip(std::span<const std::uint32_t> corners, std::vector<CornerTriple>& to) {
  for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
    addJoined({corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]}, to);
  }
}

}  // namespace whit
