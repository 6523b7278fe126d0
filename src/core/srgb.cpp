#include "core/srgb.h"

#include <cmath>
#include <limits>

namespace whit {

namespace {

// The least float in [0, 1] whose code is at least `code`, by bisection over the bits.
float leastWithCode(int code) {
  float low = 0.0f, high = 1.0f;
  if (code == 0) return low;
  while (std::nextafter(low, 2.0f) < high) {
    const float middle = low + (high - low) / 2;
    (srgbCode(static_cast<double>(middle)) >= code ? high : low) = middle;
  }
  return high;
}

std::array<float, 257> makeLeastWithCodes() {
  std::array<float, 257> least{};
  for (int code = 0; code < 256; ++code) {
    least[static_cast<std::size_t>(code)] = leastWithCode(code);
  }
  least[256] = std::numeric_limits<float>::infinity();
  return least;
}

}  // namespace

double srgbToLinear(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

double linearToSrgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

std::array<float, 256> makeLinearOfCode() {
  std::array<float, 256> table{};
  for (int code = 0; code < 256; ++code) {
    table[static_cast<std::size_t>(code)] = static_cast<float>(srgbToLinear(code / 255.0));
  }
  return table;
}

int srgbCode(double linear) {
  if (!(linear > 0)) return 0;  // NaN too
  if (linear >= 1) return 255;
  return static_cast<int>(std::floor(255 * linearToSrgb(linear) + 0.5));
}

const std::array<float, 257>& leastWithCodes() {
  static const std::array<float, 257> least = makeLeastWithCodes();
  return least;
}

}  // namespace whit
