// Images sampled on surfaces and in the sky. Frozen after loading.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/vec3.h"

namespace whit {

// How the 32 bits of a texel hold its channels, x in the low bits.
enum class TexelFormat : std::uint8_t {
  // Color: 10 bits a channel, value = (code / 1023)^2, linear light. Square-root coding puts the
  // steps where sRGB has them: an 8-bit sRGB color comes back within 1/6 of an 8-bit step, and
  // decoding is one multiplication. Channels are in [0, 1].
  color,
  // Data (normals, factors): 8 bits a channel, value = code / 255.
  data,
  // Radiance, of emission maps that go beyond 1: 9 bits a channel and in the top 5 an exponent that
  // they share, value = code * 2^(exponent - 24) (EXT_texture_shared_exponent). Up to 65408; each
  // channel is within 1/512 of the texel's largest, or within 2^-25 of what is nearly black.
  radiance,
};

// Purposes that an image is read for.
enum class TextureUse : std::uint8_t {
  color,
  emission,  // a color whose channels may go beyond 1
  data,
  bump,        // a height map becomes a normal map, a normal map stays unchanged
  mask,        // alpha, if any texel is not opaque; else the first channel
  colorAlpha,  // alpha, if any texel is not opaque; else no texture at all
};

inline TexelFormat formatOf(TextureUse use) {
  const bool isColor = use == TextureUse::color || use == TextureUse::emission;
  return isColor ? TexelFormat::color : TexelFormat::data;
}

enum class Wrap : std::uint8_t { repeat, mirror, clamp };

// `texels` holds width * height rows from the top: texel (0, 0) is at uv (0, 1), as in OBJ, where v
// points up. Sampling is bilinear with texel centers at half-integers.
struct Texture {
  std::string name;
  TexelFormat format = TexelFormat::color;
  Wrap wrapU = Wrap::repeat, wrapV = Wrap::repeat;
  int width = 1, height = 1;
  std::vector<std::uint32_t> texels;
};

// One texel of each format from channels in [0, 1], of radiance to kLargestRadianceTexel;
// out-of-range and NaN channels are clamped.
std::uint32_t encodeColorTexel(const Rgb& linear);
std::uint32_t encodeDataTexel(float r, float g, float b, float a);
std::uint32_t encodeRadianceTexel(const Rgb& radiance);
Rgb decodeRadianceTexel(std::uint32_t texel);  // exact

inline constexpr float kLargestRadianceTexel = 65408;  // 511 * 2^7

// Equirectangular radiance map: row 0 is the zenith (+y), column 0 begins at direction -z and
// columns run towards +x. Planes, so that kernels gather one channel at a time.
struct EnvironmentImage {
  int width = 0, height = 0;
  std::vector<float> r, g, b;
};

}  // namespace whit
