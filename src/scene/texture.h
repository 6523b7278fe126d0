// Images sampled on surfaces and in the sky. Frozen after loading.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "core/index.h"
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

// Kernels read texels in strips, which begin at a multiple of 64 bytes. A strip has kTexelStrip
// columns, row after row, so that the four texels of a bilinear footprint are two neighbors and the
// two that follow kTexelStrip texels later. A strip holds the kTexelCells columns of footprints
// that begin in it whole, so that neighbors repeat a column of texels. Footprint (0, 0) has its
// upper texels at (0, 0), the last its lower ones at (width - 1, height - 1); the texels beyond the
// borders are those that the wrap modes name.
using TexelStrips = std::shared_ptr<const std::uint32_t[]>;
inline constexpr int kTexelStrip = 8, kTexelCells = kTexelStrip - 1;
// A texture of this height has height + 2 rows, because footprints reach beyond either border.
inline constexpr int kTexelBorder = 2;
// Kernels find strips in float: exact up to here.
inline constexpr int kTextureSideLimit = 1 << 20;

// Texels that the copies of a texture share. They are given, or made when a frame or a mask needs
// them. Threads may ask at the same time.
class SharedTexels {
 public:
  explicit SharedTexels(std::function<std::vector<std::uint32_t>()> make)
      : make_(std::move(make)) {}
  explicit SharedTexels(std::vector<std::uint32_t> texels)
      : kept_(std::move(texels)), keptBytes_(kept_.size() * sizeof(kept_[0])) {}

  // Makes the texels for the caller alone, anew at each call.
  std::vector<std::uint32_t> make() const { return make_(); }
  // Makes the texels at the first call, unless they were given, and keeps them.
  const std::vector<std::uint32_t>& kept() const {
    if (keptBytes_ == 0) keep();
    return kept_;
  }
  std::uint64_t keptBytes() const { return keptBytes_; }

  // Everything that texels which are made depend on; digests tell textures apart by it.
  std::string recipe;

 private:
  void keep() const;

  std::function<std::vector<std::uint32_t>()> make_;
  mutable std::once_flag once_;
  mutable std::vector<std::uint32_t> kept_;
  mutable std::atomic<std::uint64_t> keptBytes_{0};
};

// `texels` holds width * height rows from the top: texel (0, 0) is at uv (0, 1), as in OBJ, where v
// points up. Texel centers lie at half-integers.
struct Texture {
  std::string name;
  TexelFormat format = TexelFormat::color;
  Wrap wrapU = Wrap::repeat, wrapV = Wrap::repeat;
  bool nearest = false;  // its texels are not interpolated; smaller mip levels are
  int width = 1, height = 1;
  std::vector<std::uint32_t> texels;
  std::shared_ptr<SharedTexels> shared;  // stands for `texels` if it is set

  std::uint32_t texel(int column, int row) const { return rows()[cellAt(column, row, width)]; }
  const std::vector<std::uint32_t>& rows() const { return shared ? shared->kept() : texels; }
  // Lets copies of the texture share its texels.
  void share() {
    if (!shared) shared = std::make_shared<SharedTexels>(std::exchange(texels, {}));
  }
  std::size_t texelCount() const { return cellsOf(width, height); }
  // Returns the number of texels in its strips.
  std::size_t packedSize() const {
    return std::size_t{1} * (width / kTexelCells + 1) * (height + kTexelBorder) * kTexelStrip;
  }
};

// Returns the index that a wrap mode gives a texel up to one row or column beyond the borders.
int wrapTexel(int texel, int size, Wrap wrap);

// Returns a texture whose texels are 0.
Texture emptyTexture(const std::string& name, TexelFormat format, int width, int height);

struct PackedTexels {
  TexelStrips strips;               // null without textures
  std::vector<std::size_t> begins;  // the index of each texture's first texel
  std::size_t count = 0;
};

// Copies the texels of all textures into strips in one block of memory. Texels that a texture does
// not share are freed as soon as they are copied, so that few are in memory twice. Throws
// Error(limit) when a 31-bit index does not reach all texels.
PackedTexels packTextures(std::vector<Texture>& textures, int threads);

// Each function encodes a texel from channels in [0, 1], or radiance up to kLargestRadianceTexel.
// Out-of-range and NaN channels are clamped.
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
