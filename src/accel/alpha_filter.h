// Decides for Embree whether a hit on a masked triangle is really there.
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace whit {

// A geometry's triangles start at `firstTriangle` of scene.triangles.
struct MaskedGeometry {
  const Scene* scene = nullptr;
  std::uint32_t firstTriangle = 0;
};

// False where the alpha mask cuts the triangle's point (u, v).
bool isOpaqueAt(const MaskedGeometry& geometry, std::uint32_t primitive, float u, float v) noexcept;

}  // namespace whit
