#include "sampling/sample_pattern.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "core/index.h"

namespace whit {

namespace {

// Returns one sample in each row and in each column, in the order of columns.
std::vector<Vec2f> rooks(int spp) {
  constexpr double kGoldenRatio = 1.61803398874989484820;

  // Column i has the height frac(0.5 + i / golden ratio) of a Fibonacci lattice.
  std::vector<std::pair<double, int>> byHeight;
  for (int i = 0; i < spp; ++i) {
    const double y = 0.5 + i / kGoldenRatio;
    byHeight.emplace_back(y - std::floor(y), i);
  }

  // The rank of its height is a column's row, so that each row has exactly one sample.
  std::ranges::sort(byHeight);
  const auto middleOf = [&](int cell) { return static_cast<float>((cell + 0.5) / spp); };
  std::vector<Vec2f> samples(byHeight.size());
  for (int row = 0; row < spp; ++row) {
    const int column = entryOf(byHeight, row).second;
    entryOf(samples, column) = {middleOf(column), middleOf(row)};
  }
  return samples;
}

double squaredDistance(const Vec2f& a, const Vec2f& b) {
  const double x = double{a.x} - double{b.x}, y = double{a.y} - double{b.y};
  return x * x + y * y;
}

// Finds the samples that stand for the whole pixel. They are near the points of the pattern of
// kProbeSamples samples. Above all their mean is in the center, because a pixel that gets no
// further samples would otherwise be displaced. There must be at least kProbeSamples samples.
class ProbeChooser {
 public:
  using Probes = std::array<std::size_t, kProbeSamples>;

  // The candidates for probe k are the samples nearest to point k of the small pattern.
  explicit ProbeChooser(const std::vector<Vec2f>& samples)
      : samples_(samples), candidates_(std::min<std::size_t>(kNearest, samples.size())) {
    const std::vector<Vec2f> wanted = rooks(kProbeSamples);
    for (const auto k : indices(near_)) {
      for (const auto i : indices(samples)) {
        near_[k].emplace_back(squaredDistance(samples[i], wanted[k]), i);
      }
      std::partial_sort(near_[k].begin(), near_[k].begin() + candidates_, near_[k].end());
    }
  }

  // All combinations of candidates are tried, at most 6^4.
  Probes choose() {
    tryFrom(0, 0, {0, 0});
    return best_;
  }

 private:
  static constexpr std::size_t kNearest = 6;

  // Tries all candidates for the probes from k on. The first k probes are `away` from the wanted
  // places, in sum of squares, and their places have this sum.
  void tryFrom(std::size_t k, double away, Vec2f sum) {
    if (k == chosen_.size()) {
      keepIfBetter(away, sum);
      return;
    }

    for (const auto i : indices(candidates_)) {
      const auto& [distance, at] = near_[k][i];
      chosen_[k] = at;
      const auto before = chosen_.begin() + k;
      if (std::find(chosen_.begin(), before, at) != before) continue;

      const Vec2f& s = samples_[at];
      tryFrom(k + 1, away + distance, {sum.x + s.x, sum.y + s.y});
    }
  }

  // The cost is the sum of squared distances to the wanted places, and 64 times that of the mean
  // from the center.
  void keepIfBetter(double away, const Vec2f& sum) {
    constexpr Vec2f kCenter{kProbeSamples / 2.0f, kProbeSamples / 2.0f};
    constexpr double kScale = 64.0 / (kProbeSamples * kProbeSamples);
    const double cost = away + kScale * squaredDistance(sum, kCenter);
    if (cost < least_) {
      least_ = cost;
      best_ = chosen_;
    }
  }

  const std::vector<Vec2f>& samples_;
  std::size_t candidates_;
  // Squared distances and indices, the candidates first.
  std::array<std::vector<std::pair<double, std::size_t>>, kProbeSamples> near_;
  Probes chosen_{}, best_{};
  double least_ = kInfinity;
};

// Puts samples into an order in which each is far from all before it, measured as if copies of the
// pixel lay side by side (Eldar et al. 1997, "The farthest point strategy for progressive image
// sampling"): among those at least 0.7 times as far as the farthest, the one that brings the mean
// of all samples nearest to the center. Distances are in whole cells, so that the order is the same
// on every machine.
class SpreadOrder {
 public:
  // Samples lie in the middles of the cells of an n x n board.
  explicit SpreadOrder(const std::vector<Vec2f>& samples)
      : n_(static_cast<std::int64_t>(samples.size())),
        distance_(samples.size(), std::numeric_limits<std::int64_t>::max() / 2) {
    const auto cellOf = [&](float place) {
      return static_cast<std::int64_t>(place * static_cast<float>(n_));
    };
    cells_.reserve(samples.size());
    for (const Vec2f& sample : samples) cells_.push_back({cellOf(sample.x), cellOf(sample.y)});
  }

  // Returns all indices, those of `first` before the others.
  template <typename First>
  std::vector<std::size_t> startingWith(const First& first) {
    for (const std::size_t i : first) take(i);
    while (order_.size() < cells_.size()) take(next());
    return order_;
  }

 private:
  static constexpr std::int64_t kTaken = -1;

  struct Cell {
    std::int64_t x = 0, y = 0;
  };

  static std::int64_t squared(std::int64_t x, std::int64_t y) { return x * x + y * y; }

  // The pattern repeats from pixel to pixel, so distances wrap around at the pixel's borders.
  std::int64_t apart(std::int64_t a, std::int64_t b) const {
    return std::min(std::abs(a - b), n_ - std::abs(a - b));
  }

  // The sum of the taken samples and this one.
  Cell summed(const Cell& c) const {
    return {sum_.x + 2 * c.x + 1 - n_, sum_.y + 2 * c.y + 1 - n_};
  }

  void take(std::size_t taken) {
    order_.push_back(taken);
    sum_ = summed(cells_[taken]);
    distance_[taken] = kTaken;

    for (const auto i : indices(cells_)) {
      const std::int64_t away =
          squared(apart(cells_[i].x, cells_[taken].x), apart(cells_[i].y, cells_[taken].y));
      distance_[i] = std::min(distance_[i], away);
    }
  }

  std::size_t next() const {
    const std::int64_t farthest = *std::ranges::max_element(distance_);
    std::size_t best = cells_.size();
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    for (const auto i : indices(cells_)) {
      // Half of the squared distance is 0.7 of the distance.
      if (distance_[i] == kTaken || 2 * distance_[i] < farthest) continue;

      const Cell with = summed(cells_[i]);
      const auto cost = squared(with.x, with.y);
      if (cost < least) {
        least = cost;
        best = i;
      }
    }
    return best;
  }

  std::int64_t n_;
  std::vector<Cell> cells_;
  std::vector<std::int64_t> distance_;  // squared, to the nearest taken sample; or kTaken
  std::vector<std::size_t> order_;
  Cell sum_;  // twice the sum of the taken samples' offsets from the center, in cells
};

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

  // The probes come first, and further samples spread over the rest of the pixel.
  std::vector<Vec2f> ordered;
  ordered.reserve(samples.size());
  for (const std::size_t i : SpreadOrder(samples).startingWith(ProbeChooser(samples).choose())) {
    ordered.push_back(samples[i]);
  }
  return ordered;
}

}  // namespace whit
