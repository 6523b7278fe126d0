// Mip maps: textures in steps of half the size (Williams 1983, "Pyramidal parametrics"), for
// lookups that stand for an area. Made when a frame asks for them (TextureFilter::trilinear).
#pragma once

#include <compare>
#include <cstddef>
#include <map>
#include <vector>

#include "bake/scene.h"

namespace whit {

// Levels of the largest texture: from 2^16 texels a side to one.
inline constexpr int kMipLevels = 17;
inline constexpr float kLargestArea = 0x1p32f;  // number of texels

// A texture as a material shows it. Rays that a mask cuts away see nothing of the texture, and
// where coverage is low little is seen of it, so its mip levels are means weighted by what is left
// of the surface: the share of a texel's area that the alpha map leaves, times the coverage map.
// Alpha maps themselves are always looked up at full size, which keeps the area that they leave.
struct ShownMap {
  std::int32_t texture = kNoTexture;
  std::int32_t alphaMap = kNoTexture;
  float alphaCutoff = 0;
  std::int32_t coverageMap = kNoTexture;

  auto operator<=>(const ShownMap&) const = default;  // NOLINT(modernize-use-nullptr): LLVM 14
};

// Returns `map` as `material` shows it. The texture is kNoTexture if the material has no such map.
ShownMap shownMap(const Material& material, std::int32_t Material::*map);

// Returns a texture of half as many texels along each axis, rounded down but at least one. Each
// texel is the mean of the area that it covers, also where its border cuts through texels; colors
// are averaged in linear light. Means are rounded to the format's codes.
Texture halved(const Texture& texture);

class MipMaps {
 public:
  MipMaps() = default;
  // Computes levels of the maps in `wanted`, on `threads` threads. The textures must outlive this
  // object. Throws Error(limit) if the system has no room for so many threads.
  MipMaps(const std::vector<Texture>& textures, const std::vector<ShownMap>& wanted,
          int threads = 1);
  // Computes the levels of all textures that materials use as colors, reflectances and normal maps.
  explicit MipMaps(const Scene& scene, int threads = 1);

  // Level 0 is the texture itself, and the only level of a map that is not wanted. Levels beyond
  // the single texel are that texel.
  const Texture& level(const ShownMap& map, int level) const;
  // Moves level 1 or a smaller one out of this object.
  Texture take(const ShownMap& map, int level);
  int levels(const ShownMap& map) const;  // distinct ones, at least 1

 private:
  const std::vector<Texture>* textures_ = nullptr;
  std::map<ShownMap, std::vector<Texture>> smaller_;  // levels 1 and up
};

}  // namespace whit
