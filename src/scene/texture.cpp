#include "scene/texture.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

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
  // So that the largest code has its top bit, or all bits where it is next to black.
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
