// The fixed pattern of samples in a pixel.
#include "sampling/sample_pattern.h"
#include "pi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace whit::test {
namespace {

using Samples = std::vector<Vec2f>;

// Returns the largest difference between the share of samples in a box [0, x) x [0, y) and its
// area: the star discrepancy, found at the corners that the samples span (Niederreiter 1992).
double starDiscrepancy(const Samples& samples) {
  std::vector<double> xs{1}, ys{1};
  for (const Vec2f& s : samples) {
    xs.push_back(s.x);
    ys.push_back(s.y);
  }

  double worst = 0;
  for (const double x : xs) {
    for (const double y : ys) {
      int open = 0, closed = 0;
      for (const Vec2f& s : samples) {
        open += s.x < x && s.y < y;
        closed += s.x <= x && s.y <= y;
      }

      const auto n = static_cast<double>(samples.size());
      worst = std::max({worst, x * y - open / n, closed / n - x * y});
    }
  }
  return worst;
}

Samples grid(int side) {
  Samples samples;
  for (int i = 0; i < side * side; ++i) {
    const auto middle = [&](int cell) { return static_cast<float>((cell + 0.5) / side); };
    samples.push_back({middle(i % side), middle(i / side)});
  }
  return samples;
}

TEST(SamplePattern, BeatsTheRegularGrid) {
  for (const int side : {2, 3, 4, 5, 8}) {
    EXPECT_LT(starDiscrepancy(samplePattern(side * side)), starDiscrepancy(grid(side))) << side;
  }
}

// Returns the root mean square error of a pixel's coverage by straight edges at all places. The
// normals of the edges turn from `from` to `to` degrees.
double edgeError(const Samples& samples, int from, int to) {
  constexpr int kFine = 64, kPlaces = 25;
  double sum = 0;
  int edges = 0;
  for (int direction = from; direction < to; ++direction) {
    const double angle = (direction + 0.5) * kPi / 180;
    const double nx = std::cos(angle), ny = std::sin(angle);

    // The exact coverage is taken from a fine grid.
    std::vector<double> fine;
    for (int i = 0; i < kFine * kFine; ++i) {
      fine.push_back(nx * ((i % kFine + 0.5) / kFine - 0.5) +
                     ny * ((i / kFine + 0.5) / kFine - 0.5));
    }
    std::sort(fine.begin(), fine.end());

    for (int step = -kPlaces; step <= kPlaces; ++step) {
      const double place = 0.7 * step / kPlaces;
      const auto below = std::lower_bound(fine.begin(), fine.end(), place) - fine.begin();

      double taken = 0;
      for (const Vec2f& s : samples) {
        taken += nx * (s.x - 0.5) + ny * (s.y - 0.5) < place;
      }

      const double error = taken / static_cast<double>(samples.size()) -
                           static_cast<double>(below) / (kFine * kFine);
      sum += error * error;
      ++edges;
    }
  }
  return std::sqrt(sum / edges);
}

// Edges within 10 degrees of the axes are the most visible, since they cross whole rows of a grid's
// samples at once. Over all directions both patterns are equally good: the sum of both errors
// depends on the number of samples.
TEST(SamplePattern, RendersNearlyLevelEdgesBetterThanTheRegularGrid) {
  for (const int side : {2, 4, 5}) {
    const Samples ours = samplePattern(side * side), regular = grid(side);
    EXPECT_LT(edgeError(ours, 80, 100), edgeError(regular, 80, 100)) << side;
    EXPECT_LT(edgeError(ours, 0, 180), 1.2 * edgeError(regular, 0, 180)) << side;
  }
}

// Each sample has a column and a row of its own.
TEST(SamplePattern, NoTwoSamplesShareARowOrAColumn) {
  for (const int n : {1, 2, 7, 16, 4096}) {
    std::set<int> rows, columns;
    for (const Vec2f& s : samplePattern(n)) {
      columns.insert(static_cast<int>(s.x * static_cast<float>(n)));
      rows.insert(static_cast<int>(s.y * static_cast<float>(n)));
    }
    for (const std::set<int>& places : {rows, columns}) {
      EXPECT_EQ(std::ssize(places), n);
      EXPECT_TRUE(*places.begin() == 0 && *places.rbegin() == n - 1) << n;
    }
  }
}

// The probe samples stand for the whole pixel: there is one in each quarter across and down.
TEST(SamplePattern, ProbeSamplesAreSpread) {
  for (const int n : {8, 16, 64, 256}) {
    const Samples samples = samplePattern(n);
    const Samples probe(samples.begin(), samples.begin() + kProbeSamples);
    EXPECT_LT(starDiscrepancy(probe), starDiscrepancy(grid(2))) << n;
  }
}

// Where radiance is linear over the pixel, the mean of the samples is the radiance at their mean
// place. The mean place of all samples is the pixel's center, and that of the probe samples is as
// near to it as the pattern allows. (The four samples nearest to the center were up to 0.14 off,
// which shifted the picture of pixels without further samples.)
// Returns how far the mean place of the first samples lies from the center.
double asideOfFirst(int count, const Samples& samples) {
  double x = 0, y = 0;
  for (int i = 0; i < count; ++i) {
    x += samples[i].x - 0.5;
    y += samples[i].y - 0.5;
  }
  return std::hypot(x, y) / count;
}

TEST(SamplePattern, SamplesAreCentered) {
  for (const int n : {1, 2, 4, 5, 7, 8, 9, 12, 16, 24, 25, 32, 64, 256}) {
    const Samples samples = samplePattern(n);
    ASSERT_EQ(std::ssize(samples), n);
    EXPECT_NEAR(asideOfFirst(n, samples), 0, n == 1 ? 0 : 1e-6) << n;
    if (n <= kProbeSamples) continue;
    EXPECT_LE(asideOfFirst(kProbeSamples, samples), n < 16 ? 0.051 : 0.025) << n;
  }
}

// The first samples of any number are spread over the pixel, so that the picture does not shift
// while more are added. In the order of columns, half of the samples would be off by 0.25.
TEST(SamplePattern, TheFirstSamplesStandForThePixel) {
  for (const int n : {16, 64, 256}) {
    const Samples samples = samplePattern(n);
    for (int count = kProbeSamples; count <= n; ++count) {
      EXPECT_LT(asideOfFirst(count, samples), 2 * count < n ? 0.1 : 0.04) << count << " of " << n;
    }
  }
}

}  // namespace
}  // namespace whit::test
