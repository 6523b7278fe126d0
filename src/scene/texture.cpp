#include "scene/texture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/huge_vector.h"
#include "core/worker_pool.h"

namespace whit {

namespace {

constexpr std::uint32_t kColorMax = 1023, kDataMax = 255, kRadianceMax = 511;
constexpr int kRadianceUnit = 24;  // with the exponent 0, a code counts 2^-24

// NaN becomes 0, because it compares false.
float unit(float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; }

// std::lround() of a code from 0 to 1023, without a call. The double below 1/2, because 1/2 itself
// would round the double below 1/2 up.
std::uint32_t roundedCode(double code) {
  return static_cast<std::uint32_t>(code + 0x1.fffffffffffffp-2);
}

std::uint32_t colorCode(float linear) {
  return roundedCode(std::sqrt(double{unit(linear)}) * kColorMax);
}

std::uint32_t dataCode(float value) { return roundedCode(double{unit(value)} * kDataMax); }

void copyTexels(const Texture& t, std::uint32_t* to) {
  const std::uint32_t* const rows = t.rows().data();

  // The columns of a strip overlap those of the next by one, so that each footprint lies in one
  // strip.
  for (int first = -1; first < t.width; first += kTexelCells) {
    std::array<int, kTexelStrip> columns{};
    for (int column = first; int& from : columns) from = wrapTexel(column++, t.width, t.wrapU);
    for (int row = -1; row <= t.height; ++row) {
      const std::uint32_t* const from = rows + cellsOf(wrapTexel(row, t.height, t.wrapV), t.width);
      for (const int column : columns) *to++ = from[column];
    }
  }
}

}  // namespace

void SharedTexels::keep() const {
  std::call_once(once_, [this] {
    kept_ = make_();
    keptBytes_ = kept_.size() * sizeof(kept_[0]);
  });
}

int wrapTexel(int texel, int size, Wrap wrap) {
  return wrap == Wrap::repeat ? (texel + size) % size : std::clamp(texel, 0, size - 1);
}

Texture emptyTexture(const std::string& name, TexelFormat format, int width, int height) {
  Texture texture;
  texture.name = name;
  texture.format = format;
  texture.width = width;
  texture.height = height;
  texture.texels.resize(cellsOf(width, height));
  return texture;
}

PackedTexels packTextures(std::vector<Texture>& textures, int threads) {
  PackedTexels packed;
  std::size_t& total = packed.count;

  for (const Texture& t : textures) {
    if (std::max(t.width, t.height) > kTextureSideLimit) {
      throwLimit("texture '" + t.name + "' has more than 2^20 texels a side");
    }
    packed.begins.push_back(total);
    total += t.packedSize();
    if (total > 0x7fffffffu) throwLimit("textures hold more than 2^31 texels");
  }
  if (total == 0) return packed;

  HugePageAllocator<std::uint32_t> memory;
  const std::shared_ptr<std::uint32_t[]> strips(
      memory.allocate(total), [=](std::uint32_t* all) mutable { memory.deallocate(all, total); });

  parallelFor(threads, textures.size(), [&](std::size_t i, int) {
    copyTexels(textures[i], strips.get() + packed.begins[i]);
    textures[i].texels = std::vector<std::uint32_t>();
  });

  packed.strips = strips;
  return packed;
}

std::uint32_t encodeColorTexel(const Rgb& linear) {
  return colorCode(linear.x) | colorCode(linear.y) << 10 | colorCode(linear.z) << 20;
}

std::uint32_t encodeDataTexel(float r, float g, float b, float a) {
  return dataCode(r) | dataCode(g) << 8 | dataCode(b) << 16 | dataCode(a) << 24;
}

std::uint32_t encodeRadianceTexel(const Rgb& radiance) {
  const auto held = [](float x) { return x > 0 ? std::min(x, kLargestRadianceTexel) : 0.0f; };
  const Rgb value{held(radiance.x), held(radiance.y), held(radiance.z)};

  int exponent = 0;
  std::frexp(maxComponent(value), &exponent);
  // The exponent gives the largest code its top bit; near black it is 0.
  exponent = std::max(exponent + kRadianceUnit - 9, 0);

  const auto code = [&](float x) {
    return static_cast<std::uint32_t>(std::lround(std::ldexp(x, kRadianceUnit - exponent)));
  };
  if (code(maxComponent(value)) > kRadianceMax) ++exponent;  // rounded up to the next power of two

  return code(value.x) | code(value.y) << 9 | code(value.z) << 18 |
         static_cast<std::uint32_t>(exponent) << 27;
}

Rgb decodeRadianceTexel(std::uint32_t texel) {
  const int exponent = static_cast<int>(texel >> 27) - kRadianceUnit;
  const auto value = [&](int shift) {
    return std::ldexp(static_cast<float>(texel >> shift & kRadianceMax), exponent);
  };
  return {value(0), value(9), value(18)};
}

}  // namespace whit
