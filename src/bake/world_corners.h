// Triangles where they stand.
#pragma once

#include <array>
#include <cstdint>

#include "bake/scene.h"

namespace whit {

using Corners = std::array<Vec3d, 3>;

// Carried by the map, if there is one.
Corners cornersOf(const TriangleRecord& triangle, const Affine* toWorld);

// The corners of a triangle of the scene (an index into Scene::triangles), transformed by the
// instance unless that is kNoInstance.
Corners worldCorners(const Scene& scene, std::uint32_t triangle, std::uint32_t instance);

}  // namespace whit
