#include "sampling/sample_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

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

// Samples that stand for the whole pixel: near the places of the pattern of as many, and above all
// with their mean in the center, since a pixel that is left with them would else show what lies
// beside it. Their indices; `samples` are at least as many.
std::array<std::size_t, kProbeSamples> chooseProbes(const std::vector<Vec2f>& samples) {
  constexpr std::size_t kNearest = 6;
  constexpr double kWeightOfMean = 64;
  const std::vector<Vec2f> wanted = rooks(kProbeSamples);
  const std::size_t candidates = std::min(kNearest, samples.size());
  std::array<std::vector<std::pair<double, std::size_t>>, kProbeSamples> near;
  for (std::size_t k = 0; k < near.size(); ++k) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      near[k].emplace_back(squaredDistance(samples[i], wanted[k]), i);
    }
    std::partial_sort(near[k].begin(), near[k].begin() + static_cast<std::ptrdiff_t>(candidates),
                      near[k].end());
  }
  std::array<std::size_t, kProbeSamples> chosen{}, best{};
  double least = std::numeric_limits<double>::infinity();
  const auto choose = [&](auto&& self, std::size_t k, double away, Vec2f sum) -> void {
    if (k == chosen.size()) {
      const Vec2f center{kProbeSamples / 2.0f, kProbeSamples / 2.0f};
      constexpr double kScale = kWeightOfMean / (kProbeSamples * kProbeSamples);
      const double cost = away + kScale * squaredDistance(sum, center);
      if (cost < least) least = cost, best = chosen;
      return;
    }
    for (std::size_t i = 0; i < candidates; ++i) {
      const auto& [distance, at] = near[k][i];
      chosen[k] = at;
      const auto before = chosen.begin() + static_cast<std::ptrdiff_t>(k);
      if (std::find(chosen.begin(), before, at) != before) continue;
      const Vec2f& s = samples[at];
      self(self, k + 1, away + distance, {sum.x + s.x, sum.y + s.y});
    }
  };
  choose(choose, 0, 0, {0, 0});
  return best;
}

}  // namespace

std::size_t nearestToCenter(const std::vector<Vec2f>& samples) {
  const auto isNearer = [](const Vec2f& a, const Vec2f& b) {
    constexpr Vec2f kCenter{0.5f, 0.5f};
    return squaredDistance(a, kCenter) < squaredDistance(b, kCenter);
  };
  return static_cast<std::size_t>(std::min_element(samples.begin(), samples.end(), isNearer) -
                                  samples.begin());
}

std::vector<Vec2f> samplePattern(int spp) {
  std::vector<Vec2f> samples = rooks(spp);
  if (spp <= kProbeSamples) return samples;
  const auto probes = chooseProbes(samples);
  std::vector<Vec2f> ordered;
  ordered.reserve(samples.size());
  for (const std::size_t probe : probes) ordered.push_back(samples[probe]);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (std::find(probes.begin(), probes.end(), i) == probes.end()) ordered.push_back(samples[i]);
  }
  return ordered;
}

}  // namespace whit
