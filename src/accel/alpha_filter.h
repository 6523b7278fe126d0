// Decides for Embree whether a hit on a masked triangle is really there.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "accel/alpha_map.h"
#include "scene/scene.h"

namespace whit {

// One a texture of the scene; null where no material uses it as a mask.
using AlphaMaps = std::vector<std::unique_ptr<AlphaMap>>;
AlphaMaps makeAlphaMaps(const Scene& scene);

// A geometry's triangles start at `firstTriangle` of scene.triangles.
struct MaskedGeometry {
  const Scene* scene = nullptr;
  const AlphaMaps* maps = nullptr;
  std::uint32_t firstTriangle = 0;
};

// False where the alpha mask cuts the triangle's point (u, v).
bool isOpaqueAt(const MaskedGeometry& geometry, std::uint32_t primitive, float u, float v) noexcept;

}  // namespace whit
