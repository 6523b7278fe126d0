#include "scene/texture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/huge_vector.h"
#include "core/index.h"
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
  return roundedCode(std::sqrt(static_cast<double>(unit(linear))) * kColorMax);
}

std::uint32_t dataCode(float value) {
  return roundedCode(static_cast<double>(unit(value)) * kDataMax);
}

void copyTexels(const Texture& t, std::uint32_t* to) {
  if (t.strips) {
    std::copy_n(t.strips.get() + t.firstTexel, t.packedSize(), to);
    return;
  }

  // The columns of a strip overlap those of the next by one, so that each footprint lies in one
  // strip.
  for (int first = -1; first < t.width; first += kTexelCells) {
    std::array<int, kTexelStrip> columns{};
    for (int column = first; int& from : columns) from = wrapTexel(column++, t.width, t.wrapU);
    for (int row = -1; row <= t.height; ++row) {
      const int from = wrapTexel(row, t.height, t.wrapV);
      for (const int column : columns) *to++ = t.texel(column, from);
    }
  }
}

}  // namespace

const std::vector<std::uint32_t>& LateTexels::kept() const {
  std::call_once(once_, [this] {
    kept_ = make_();
    keptBytes_ = kept_.size() * sizeof(kept_[0]);
  });
  return kept_;
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

void packTextures(std::vector<Texture>& textures, int threads) {
  std::vector<std::size_t> begins;
  std::size_t total = 0;

  for (const Texture& t : textures) {
    if (std::max(t.width, t.height) > kTextureSideLimit) {
      throwLimit("texture '" + t.name + "' has more than 2^20 texels a side");
    }
    begins.push_back(total);
    if (!t.late) total += t.packedSize();
    if (total > 0x7fffffffu) throwLimit("textures hold more than 2^31 texels");
  }
  if (total == 0) return;

  HugePageAllocator<std::uint32_t> memory;
  const std::shared_ptr<std::uint32_t[]> strips(
      memory.allocate(total), [=](std::uint32_t* all) mutable { memory.deallocate(all, total); });

  parallelFor(threads, textures.size(), [&](std::size_t i, int) {
    Texture& t = textures[i];
    if (t.late) return;
    copyTexels(t, strips.get() + begins[i]);
    // The copied texels are freed at once, so that few textures are in memory twice.
    t.texels = std::vector<std::uint32_t>();
    t.strips = strips;
    t.firstTexel = begins[i];
  });
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
