#include "scene/sample_pattern.h"

#include <algorithm>
#include <cmath>

namespace whit {

std::vector<Vec2f> samplePattern(int spp) {
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

}  // namespace whit
