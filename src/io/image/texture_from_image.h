// Converts decoded images to what shading reads: textures, environments, normal maps.
#pragma once

#include <cstddef>
#include <string>

#include "io/image/image_file.h"
#include "scene/texture.h"

namespace whit {

// Makes a texture of the given format. Color textures decode sRGB from 8-bit codes; data textures
// take codes as they are. A single channel is r, g and b, the second or fourth is alpha; a missing
// alpha is 1.
Texture makeTexture(const std::string& name, const RawImage& raw, TexelFormat format);

// Counts the texels of an image of reflectances that makeTexture() clamps to 1.
void warnOfClampedColors(const std::string& name, const RawImage& raw, Warnings& warnings);

// Makes a texture of emitted colors: linear images with texels above 1 keep their range
// (TexelFormat::radiance), all others are color textures. Values beyond that format's largest one
// are clamped and counted in `warnings`.
Texture makeEmissionTexture(const std::string& name, const RawImage& raw, Warnings& warnings);
TexelFormat emissionFormat(const RawImage& raw);
std::uint32_t encodeTexel(const Rgb& linear, TexelFormat format);  // of color or radiance

// Makes an environment of linear light, see linearPixel(). A cube becomes an image that is four
// faces wide and two faces high.
EnvironmentImage makeEnvironment(const RawImage& raw);

// True if there is an alpha channel (2 or 4 channels) with a texel below opaque.
bool hasTranslucentAlpha(const RawImage& raw);

// Makes a data texture of the alpha channel alone.
Texture makeAlphaTexture(const std::string& name, const RawImage& raw);

// Returns a stored channel of pixel `i`: r, g, b and alpha are 0 to 3. Codes become fractions of
// 255. A gray image has one value for r, g and b; a missing alpha is 1.
inline float valueAt(const RawImage& raw, std::size_t i, std::size_t channel) {
  const auto channels = static_cast<std::size_t>(raw.channels);
  std::size_t place = i * channels;
  if (channel == 3) {
    if (channels % 2 != 0) return 1;
    place += channels - 1;
  } else if (channels >= 3) {
    place += channel;
  }
  return raw.linear ? raw.values[place] : static_cast<float>(raw.codes[place]) / 255.0f;
}

// Returns true if a bump map holds heights: it has one or two channels, or is gray. Normal maps are
// never gray: their blue is near 1 where red and green are near 1/2.
bool looksLikeHeights(const RawImage& raw);

// Width of a tile in heights: `-bm 1` raises white above black by 1/kTileHeights of the tile. The
// MTL format does not define it; this value gives common bump maps a visible, moderate relief.
inline constexpr float kTileHeights = 64;

// Makes tangent-space normals (data; +y towards greater v) from the heights in the first channel by
// central differences.
Texture normalsFromHeights(const std::string& name, const RawImage& raw, float bumpScale,
                           Wrap wrapU, Wrap wrapV);

}  // namespace whit
