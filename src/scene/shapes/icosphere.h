// The subdivided icosahedron: unit points and triangles, 20 * 4^level of them.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/vec3.h"

namespace whit::procedural {

std::pair<std::vector<Vec3d>, std::vector<std::array<std::uint32_t, 3>>> icosphereMesh(int level);

}  // namespace whit::procedural
