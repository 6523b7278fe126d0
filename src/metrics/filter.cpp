#include "metrics/filter.h"

#include <algorithm>

namespace whit {

namespace {

// Innermost along x in both directions, which is what compilers turn into vector code.
void addScaled(float* sum, const float* values, float weight, int count) {
  for (int x = 0; x < count; ++x) sum[x] += weight * values[x];
}

}  // namespace

Plane filterAlongX(const Plane& plane, const Taps& taps) {
  const int radius = static_cast<int>(taps.size() / 2);
  Plane out(plane.width, plane.height);
  std::vector<float> padded(static_cast<std::size_t>(plane.width) + 2 * taps.size());
  for (int y = 0; y < plane.height; ++y) {
    const float* row = plane.row(y);
    std::fill_n(padded.begin(), radius, row[0]);
    std::copy(row, row + plane.width, padded.begin() + radius);
    std::fill_n(padded.begin() + radius + plane.width, radius, row[plane.width - 1]);
    for (std::size_t i = 0; i < taps.size(); ++i)
      addScaled(out.row(y), padded.data() + i, taps[i], plane.width);
  }
  return out;
}

Plane filterAlongY(const Plane& plane, const Taps& taps) {
  const int radius = static_cast<int>(taps.size() / 2);
  Plane out(plane.width, plane.height);
  for (int y = 0; y < plane.height; ++y) {
    for (std::size_t i = 0; i < taps.size(); ++i) {
      const int from = y - radius + static_cast<int>(i);
      addScaled(out.row(y), plane.row(std::clamp(from, 0, plane.height - 1)), taps[i], plane.width);
    }
  }
  return out;
}

}  // namespace whit
