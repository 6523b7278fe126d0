// Decides for Embree whether a hit on a filtered triangle is really there.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bake/scene.h"

namespace whit {

// An alpha mask: a byte a texel, and the bounds of each cell of 8x8 texels, which settle most
// lookups from a table that stays in the cache.
class AlphaMap {
 public:
  explicit AlphaMap(const Texture& texture);

  // True if the bilinear alpha at texture coordinates (u, v) is at least `cutoff`.
  bool isOpaqueAt(float u, float v, float cutoff) const noexcept;

 private:
  struct Bounds {
    std::uint8_t least = 255, most = 0;
  };

  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(column);
  }
  Bounds boundsOf(int cellX, int cellY) const;

  Wrap wrapU_, wrapV_;
  int width_, height_;
  int cellsAcross_;
  std::vector<std::uint8_t> alpha_;
  std::vector<Bounds> cells_;  // of every footprint whose lower texel lies in the cell
};

// One map for each texture of the scene; null where no material uses it as a mask.
using AlphaMaps = std::vector<std::unique_ptr<AlphaMap>>;
AlphaMaps makeAlphaMaps(const Scene& scene);

// The members of a masked triangle that a lookup reads take half a cache line; its record for
// shading takes a whole one.
struct alignas(32) MaskedTriangle {
  float uv[6];
  std::uint32_t mask;  // index into MaskedGeometry::masks
};

// A material's mask; all is opaque where there is no map.
struct Mask {
  const AlphaMap* map = nullptr;
  float cutoff = 0, shadowCutoff = 0;
  // For shadows besides, where the map above says nothing of coverage.
  const AlphaMap* coverage = nullptr;
  float coverageCutoff = 0;
  bool doubleSided = true;
};

// `maps` must outlive it; where they are empty there is no mask.
Mask maskOf(const Material& material, const AlphaMaps& maps);

// False where the mask, cut at that member of it, cuts the point with these texture coordinates;
// for shadows also where less than half of it is there.
template <float Mask::*kCutoff>
bool isOpaqueAt(const Mask& mask, float s, float t) noexcept {
  if (!mask.map) return true;
  const bool opaque = mask.map->isOpaqueAt(s, t, mask.*kCutoff);
  if constexpr (kCutoff == &Mask::shadowCutoff) {
    if (mask.coverage) return opaque && mask.coverage->isOpaqueAt(s, t, mask.coverageCutoff);
  }
  return opaque;
}

// The same for the point (u, v) of a triangle with these texture coordinates at its corners.
template <float Mask::*kCutoff>
bool isOpaqueAt(const Mask& mask, const float (&uv)[6], float u, float v) noexcept {
  const float w = 1.0f - u - v;
  return isOpaqueAt<kCutoff>(mask, uv[0] * w + uv[2] * u + uv[4] * v,
                             uv[1] * w + uv[3] * u + uv[5] * v);
}

// The masked triangles of one Embree geometry, in its order.
struct MaskedGeometry {
  // Takes the triangles of scene.triangles from `first` to before `end`. `maps` must outlive it;
  // where they are empty there are no masks.
  MaskedGeometry(const Scene& scene, const AlphaMaps& maps, std::uint32_t first, std::uint32_t end);
  // After moveScene(): a skin may have turned triangles over. `records` begin with the first.
  void update(const TriangleRecord* records);

  std::vector<MaskedTriangle> triangles;
  std::vector<Mask> masks;  // one a material of the scene
  bool anyMask = false, anySingleSided = false;
};

// True if rays pass the back of this triangle.
inline bool isSingleSided(const MaskedGeometry& geometry, std::uint32_t primitive) noexcept {
  return !geometry.masks[geometry.triangles[primitive].mask].doubleSided;
}

// True if the triangle's point (u, v) is cut away.
template <float Mask::*kCutoff>
bool isOpaqueAt(const MaskedGeometry& geometry, std::uint32_t primitive, float u,
                float v) noexcept {
  const MaskedTriangle& t = geometry.triangles[primitive];
  return isOpaqueAt<kCutoff>(geometry.masks[t.mask], t.uv, u, v);
}

}  // namespace whit
