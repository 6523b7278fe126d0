// Triangles that lie in each other's place: which of them a ray meets would be left to the order in
// which they are tested, and with it the last bits of the picture. Internal to finalize().
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/vec3.h"

namespace whit {

// A triangle by its baked corners, and what must be equal too for one of two to be redundant.
struct PlacedTriangle {
  std::array<Vec3f, 3> corners;
  std::uint32_t material = 0;
};

// Numbers, ascending, of triangles that have the three corners, in whatever order, and the material
// of an earlier one. `triangle(i)` is asked for each i below `count`, more than once. Takes 8 bytes
// a triangle while it runs.
std::vector<std::uint64_t> findCoincident(
    std::uint64_t count, const std::function<PlacedTriangle(std::uint64_t)>& triangle);

}  // namespace whit
