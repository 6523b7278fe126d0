// The color of a texel, as kernels and reference decode it.
#pragma once

#include <cstdint>

#include "core/vec3.h"

namespace whit {

inline Rgb decodeColorTexel(std::uint32_t texel) {
  const auto value = [&](int shift) {
    const auto code = texel >> shift & 1023u;
    // The square of a code is exact in float, so that one rounding is left.
    return static_cast<float>(code * code) * (1.0f / (1023 * 1023));
  };
  return {value(0), value(10), value(20)};
}

}  // namespace whit
