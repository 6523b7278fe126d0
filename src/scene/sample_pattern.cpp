#include "scene/sample_pattern.h"

#include <algorithm>
#include <cmath>

namespace whit {

namespace {

// Rooks: one sample a row and a column, in the order of columns.
std::vector<Vec2f> rooks(int spp) {
  constexpr double kGoldenRatio = 1.61803398874989484820;
  std::vector<std::pair<double, int>> byHeight;
  for (int i = 0; i < spp; ++i) {
    const double y = 0.5 + i / kGoldenRatio;
    byHeight.emplace_back(y - std::floor(y), i);
  }
  std::sort(byHeight.begin(), byHeight.end());
  const auto middleOf = [&](int cell) { return static_cast<float>((cell + 0.5) / spp); };
  std::vector<Vec2f> samples(byHeight.size());
  for (int row = 0; row < spp; ++row) {
    const int column = byHeight[static_cast<std::size_t>(row)].second;
    samples[static_cast<std::size_t>(column)] = {middleOf(column), middleOf(row)};
  }
  return samples;
}

double squaredDistance(const Vec2f& a, const Vec2f& b) {
  const double x = double{a.x} - double{b.x}, y = double{a.y} - double{b.y};
  return x * x + y * y;
}

}  // namespace

std::vector<Vec2f> samplePattern(int spp) {
  std::vector<Vec2f> samples = rooks(spp);
  if (spp <= kPilotSamples) return samples;
  auto next = samples.begin();
  for (const Vec2f& wanted : rooks(kPilotSamples)) {
    const auto nearest = std::min_element(next, samples.end(), [&](const Vec2f& a, const Vec2f& b) {
      return squaredDistance(a, wanted) < squaredDistance(b, wanted);
    });
    std::iter_swap(next++, nearest);
  }
  return samples;
}

}  // namespace whit
