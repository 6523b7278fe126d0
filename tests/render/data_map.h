// Textures of data that have their values in one channel.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "verify/scene_builder.h"

namespace whit::test {

// The values are in red, as masks, coverage and occlusion are, or in green, as roughness is. The
// other channels have values that nothing may look up.
inline Texture dataMap(int width, const std::vector<float>& values, bool inGreen = false) {
  std::vector<std::uint32_t> texels;
  for (const float v : values) {
    texels.push_back(inGreen ? encodeDataTexel(0.3f, v, 0.7f, 1)
                             : encodeDataTexel(v, 0.3f, 0.7f, 1));
  }
  const int height = static_cast<int>(values.size()) / width;
  return verify::makeTexture(TexelFormat::data, width, height, std::move(texels));
}

}  // namespace whit::test
