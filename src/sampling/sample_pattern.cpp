#include "sampling/sample_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
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
  std::ranges::sort(byHeight);
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

// All indices, those of `first` before the others: of these always one that is far from all before
// it, where pixels lie side by side (Eldar et al. 1997, "The farthest point strategy for
// progressive image sampling"); of those at least 0.7 times as far as the farthest, the one that
// brings the mean of all nearest to the center. In whole cells: the order is the same on every
// machine.
std::vector<std::size_t> spreadOrder(const std::vector<Vec2f>& samples,
                                     const std::vector<std::size_t>& first) {
  struct Cell {
    std::int64_t x = 0, y = 0;
  };
  const auto n = static_cast<std::int64_t>(samples.size());
  const auto cellOf = [&](float place) {
    return static_cast<std::int64_t>(place * static_cast<float>(n));
  };
  std::vector<Cell> cells;
  cells.reserve(samples.size());
  for (const Vec2f& sample : samples) cells.push_back({cellOf(sample.x), cellOf(sample.y)});
  const auto squared = [](std::int64_t x, std::int64_t y) { return x * x + y * y; };
  const auto apart = [&](std::int64_t a, std::int64_t b) {
    return std::min(std::abs(a - b), n - std::abs(a - b));
  };
  constexpr std::int64_t kTaken = -1;
  std::vector<std::int64_t> distance(samples.size(), std::numeric_limits<std::int64_t>::max() / 2);
  std::vector<std::size_t> order;
  Cell sum;  // of twice the way from the center
  const auto summed = [&](const Cell& c) {
    return Cell{sum.x + 2 * c.x + 1 - n, sum.y + 2 * c.y + 1 - n};
  };
  const auto take = [&](std::size_t taken) {
    order.push_back(taken);
    sum = summed(cells[taken]);
    distance[taken] = kTaken;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::int64_t away =
          squared(apart(cells[i].x, cells[taken].x), apart(cells[i].y, cells[taken].y));
      distance[i] = std::min(distance[i], away);
    }
  };
  const auto next = [&] {
    const std::int64_t farthest = *std::ranges::max_element(distance);
    std::size_t best = samples.size();
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (distance[i] == kTaken || 2 * distance[i] < farthest) continue;
      const Cell with = summed(cells[i]);
      if (squared(with.x, with.y) < least) least = squared(with.x, with.y), best = i;
    }
    return best;
  };
  for (const std::size_t i : first) take(i);
  while (order.size() < samples.size()) take(next());
  return order;
}

}  // namespace

std::size_t nearestToCenter(const std::vector<Vec2f>& samples) {
  const auto isNearer = [](const Vec2f& a, const Vec2f& b) {
    constexpr Vec2f kCenter{0.5f, 0.5f};
    return squaredDistance(a, kCenter) < squaredDistance(b, kCenter);
  };
  return static_cast<std::size_t>(std::ranges::min_element(samples, isNearer) - samples.begin());
}

std::vector<Vec2f> samplePattern(int spp) {
  std::vector<Vec2f> samples = rooks(spp);
  if (spp <= kProbeSamples) return samples;
  const auto probes = chooseProbes(samples);
  std::vector<Vec2f> ordered;
  ordered.reserve(samples.size());
  for (const std::size_t i : spreadOrder(samples, {probes.begin(), probes.end()})) {
    ordered.push_back(samples[i]);
  }
  return ordered;
}

}  // namespace whit
