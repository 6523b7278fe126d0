// Separable filters over planes; private to this folder.
#pragma once

#include <cstddef>
#include <vector>

namespace whit {

struct Plane {
  int width = 0, height = 0;
  std::vector<float> values;  // row by row

  Plane() = default;
  Plane(int w, int h)
      : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  float* row(int y) {
    return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
  }
  const float* row(int y) const {
    return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
  }
};

// Weights at -radius .. radius, so always an odd number of them.
using Taps = std::vector<float>;

// Each value is the sum of taps[i] * neighbor i; beyond the border the nearest value is repeated.
Plane filterAlongX(const Plane& plane, const Taps& taps);
Plane filterAlongY(const Plane& plane, const Taps& taps);

}  // namespace whit
