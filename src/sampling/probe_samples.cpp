#include "sampling/probe_samples.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace whit {

namespace {

// In units of the contrast that makes neighboring centers an edge. Samples of one pixel that
// differ by less than twice that have a mean that is off by less than it; and only part of what
// begins beyond the border lies within. With half of both, whitted at 16 samples and contrast 16
// took 1.1 times the rays for 0.98 times the FLIP.
constexpr int kWithinPixel = 2, kAcrossBorder = 4;

int largestDifference(std::uint32_t a, std::uint32_t b) {
  int largest = 0;
  for (int shift = 0; shift < 24; shift += 8) {
    const int difference =
        static_cast<int>(a >> shift & 0xFFu) - static_cast<int>(b >> shift & 0xFFu);
    largest = std::max(largest, std::abs(difference));
  }
  return largest;
}

// Among the probes of the pixel at (dx, dy) relative to another pixel, the one nearest to that
// other pixel's center.
std::size_t nearestProbe(const std::vector<Vec2f>& pattern, int dx, int dy) {
  std::size_t nearest = 0;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t k = 0; k < kProbeSamples; ++k) {
    const float x = static_cast<float>(dx) + pattern[k].x - 0.5f;
    const float y = static_cast<float>(dy) + pattern[k].y - 0.5f;
    if (x * x + y * y < least) least = x * x + y * y, nearest = k;
  }
  return nearest;
}

}  // namespace

ProbeSamples::ProbeSamples(const Crop& window, const std::vector<std::uint8_t>& edges,
                           const std::vector<Vec2f>& pattern)
    : window_(window), edges_(edges), samples_(edges.size()) {
  for (std::size_t i = 0; i < nearest_.size(); ++i) {
    const int place = static_cast<int>(i);
    nearest_[i] = nearestProbe(pattern, place % 3 - 1, place / 3 - 1);
  }
}

bool ProbeSamples::differ(int x, int y, int contrast) const {
  const PixelProbes& own = at(x, y);
  for (std::size_t a = 1; a < kProbeSamples; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (largestDifference(own.codes[a], own.codes[b]) > kWithinPixel * contrast) return true;
    }
  }
  for (std::size_t i = 0; i < nearest_.size(); ++i) {
    const int nextX = x + static_cast<int>(i) % 3 - 1, nextY = y + static_cast<int>(i) / 3 - 1;
    if (!inside(nextX, nextY) || edges_[index(nextX, nextY)] == 0) continue;
    const std::uint32_t beyond = at(nextX, nextY).codes[nearest_[i]];
    for (const std::uint32_t code : own.codes) {
      if (largestDifference(code, beyond) > kAcrossBorder * contrast) return true;
    }
  }
  return false;
}

}  // namespace whit
