// Decides for Embree whether a hit on a filtered triangle is really there.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "bake/scene.h"
#include "core/index.h"

namespace whit {

// An alpha mask with a byte for each texel. The bounds of each cell of 8x8 texels decide most
// lookups and stay in the cache.
class AlphaMap {
 public:
  explicit AlphaMap(const Texture& texture);

  // Returns by how much the alpha at texture coordinates (u, v) is above `cutoff`; 1 or -1 where
  // the bounds of the cell alone show that it is well above or below. Without interpolation the
  // margin is at most the distance from the texel's border, so that close calls are known. A cutoff
  // that differs from point to point makes close calls where the texels are equal, too.
  float marginAt(float u, float v, float cutoff, bool cutoffVaries = false) const noexcept;

 private:
  struct Bounds {
    std::uint8_t least = 255, most = 0;
  };

  std::size_t index(int row, int column) const { return cellAt(column, row, width_); }
  Bounds boundsOf(int cellX, int cellY) const;

  Wrap wrapU_, wrapV_;
  bool nearest_;
  int width_, height_;
  int cellsAcross_;
  std::vector<std::uint8_t> alpha_;
  std::vector<Bounds> cells_;  // bounds of all footprints whose lower texel lies in the cell
};

// A material's mask; all is opaque where there is no map.
struct Mask {
  std::shared_ptr<const AlphaMap> map;
  float cutoff = 0, shadowCutoff = 0;
  // Shadows are cut by this map as well, where the map above does not contain the coverage.
  std::shared_ptr<const AlphaMap> coverage;
  float coverageCutoff = 0;
  bool doubleSided = true;
  bool byVertex = false;  // Material::alphaByVertex, in scenes with second texture coordinates
};

// Returns one mask for each material. None has a map without Effect::alphaMasks.
std::vector<Mask> makeMasks(const Scene& scene, EffectSet effects);

// A margin of alpha below this may change its sign with the rounding of u and v, which differs
// between processors in Embree.
inline constexpr float kCloseCall = 1.0f / 64;

// Returns a number below 0 where the mask, with that cutoff of it, cuts the point with these
// texture coordinates; for shadows also where less than half of the point is covered. `alpha` is
// above 0 and multiplies the texels.
template <float Mask::*kCutoff>
float marginAt(const Mask& mask, float s, float t, float alpha = 1) noexcept {
  if (!mask.map) return 1;
  const float margin = mask.map->marginAt(s, t, mask.*kCutoff / alpha, mask.byVertex);
  if constexpr (kCutoff == &Mask::shadowCutoff) {
    if (mask.coverage) {
      const float cutoff = mask.coverageCutoff / alpha;
      return std::min(margin, mask.coverage->marginAt(s, t, cutoff, mask.byVertex));
    }
  }
  return margin;
}

// Does the same for the point (u, v) of a triangle of the scene.
template <float Mask::*kCutoff>
float marginAt(const Mask& mask, const Scene& scene, std::uint32_t triangle, float u,
               float v) noexcept {
  const float w = 1.0f - u - v;
  const float(&uv)[6] = scene.triangles[triangle].uv;
  const float s = uv[0] * w + uv[2] * u + uv[4] * v, t = uv[1] * w + uv[3] * u + uv[5] * v;
  if (!mask.byVertex) return marginAt<kCutoff>(mask, s, t);

  // The division by it stays finite.
  constexpr float kLeastAlpha = 1e-9f;
  const float(&lacks)[6] = scene.secondUvs[triangle].uv;
  const float alpha = 1.0f - (lacks[0] * w + lacks[2] * u + lacks[4] * v);
  return marginAt<kCutoff>(mask, s, t, std::max(alpha, kLeastAlpha));
}

// The triangles of one Embree geometry, as its filters read them.
struct FilteredTriangles {
  const Scene& scene;
  std::uint32_t first;  // number of the first triangle
  const Mask* masks;    // a mask for each material of the scene

  const Mask& maskOf(std::uint32_t primitive) const {
    return masks[scene.triangles[first + primitive].material];
  }
};

}  // namespace whit
