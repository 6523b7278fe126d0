// Polygons in space, cut into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/vec3.h"

namespace whit {

// Beyond this many corners only a fan is tried: clipping ears takes up to the cube of it.
inline constexpr std::size_t kEarCornerLimit = 512;

// Appends the triangles of the simple polygon `corners` (at least 3) to `triangles`, in its sense
// of rotation, as indices into `corners`: a quad along its shorter inner diagonal, others by
// clipping ears (Meisters 1975, "Polygons have ears") in the plane of Newell's normal. Returns
// false where that was not possible (crossing edges, no plane, too many corners of a concave
// polygon) and a fan was made instead.
bool triangulate(const std::vector<Vec3d>& corners,
                 std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace whit
