#include "scene/texture.h"

#include <algorithm>
#include <cmath>

namespace whit {

namespace {

constexpr std::uint32_t kColorMax = 1023, kDataMax = 255;

// NaN becomes 0, because it compares false.
float unit(float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; }

std::uint32_t colorCode(float linear) {
  return static_cast<std::uint32_t>(
      std::lround(std::sqrt(static_cast<double>(unit(linear))) * kColorMax));
}

std::uint32_t dataCode(float value) {
  return static_cast<std::uint32_t>(std::lround(static_cast<double>(unit(value)) * kDataMax));
}

// The square of a code is exact in float, so that one rounding is left.
float colorValue(std::uint32_t code) {
  return static_cast<float>(code * code) * (1.0f / static_cast<float>(kColorMax * kColorMax));
}

}  // namespace

std::uint32_t encodeColorTexel(const Rgb& linear) {
  return colorCode(linear.x) | colorCode(linear.y) << 10 | colorCode(linear.z) << 20;
}

std::uint32_t encodeDataTexel(float r, float g, float b, float a) {
  return dataCode(r) | dataCode(g) << 8 | dataCode(b) << 16 | dataCode(a) << 24;
}

Rgb decodeColorTexel(std::uint32_t texel) {
  return {colorValue(texel & kColorMax), colorValue(texel >> 10 & kColorMax),
          colorValue(texel >> 20 & kColorMax)};
}

}  // namespace whit
