// Mip maps: textures in steps of half the size (Williams 1983, "Pyramidal parametrics"), for
// lookups that stand for an area. Made when a frame asks for them (TextureFilter::trilinear).
#pragma once

#include <cstddef>
#include <vector>

#include "bake/scene.h"

namespace whit {

// Levels of the largest texture: from 2^16 texels a side to one.
inline constexpr int kMipLevels = 17;
inline constexpr float kLargestArea = 0x1p32f;  // in texels

// Half as many texels along each axis, rounded down but at least one. Each is the mean of the area
// that it covers, also where that cuts through texels; of colors the mean of their light. Rounded
// to the format's codes.
Texture halved(const Texture& texture);

class MipMaps {
 public:
  MipMaps() = default;
  // Maps of the textures `wanted`; one flag a texture. The textures must outlive this. Shared among
  // `threads`. Throws Error(limit) where the system has no room for so many.
  MipMaps(const std::vector<Texture>& textures, const std::vector<bool>& wanted, int threads = 1);
  // Maps of the textures that materials use as colors, reflectances and normal maps.
  explicit MipMaps(const Scene& scene, int threads = 1);

  // 0 is the texture itself, and so is its only level if it is not wanted; what follows the single
  // texel is that texel.
  const Texture& level(std::size_t texture, int level) const;
  // Moves a smaller level out, or copies the texture itself.
  Texture take(std::size_t texture, int level);
  int levels(std::size_t texture) const;  // distinct ones, at least 1

 private:
  const std::vector<Texture>* textures_ = nullptr;
  std::vector<std::vector<Texture>> smaller_;  // levels 1 and up of each texture
};

}  // namespace whit
