// The fixed pattern of samples in a pixel.
#include "sampling/sample_pattern.h"
#include "pi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace whit::test {
namespace {

// Returns the largest difference between the share of samples in a box [0, x) x [0, y) and its
// area: the star discrepancy, found at the corners that the samples span (Niederreiter 1992).
double starDiscrepancy(const std::vector<Vec2f>& samples) {
  std::vector<double> xs{1}, ys{1};
  for (const Vec2f& s : samples) xs.push_back(double{s.x}), ys.push_back(double{s.y});

  double worst = 0;
  for (const double x : xs) {
    for (const double y : ys) {
      int open = 0, closed = 0;
      for (const Vec2f& s : samples) {
        open += double{s.x} < x && double{s.y} < y;
        closed += double{s.x} <= x && double{s.y} <= y;
      }

      const auto n = static_cast<double>(samples.size());
      worst = std::max({worst, x * y - open / n, closed / n - x * y});
    }
  }
  return worst;
}

std::vector<Vec2f> grid(int side) {
  std::vector<Vec2f> samples;
  for (int i = 0; i < side * side; ++i) {
    samples.push_back({(static_cast<float>(i % side) + 0.5f) / static_cast<float>(side),
                       (static_cast<float>(i / side) + 0.5f) / static_cast<float>(side)});
  }
  return samples;
}

TEST(SamplePattern, BeatsTheRegularGrid) {
  for (const int side : {2, 3, 4, 5, 8}) {
    const double ours = starDiscrepancy(samplePattern(side * side));
    const double regular = starDiscrepancy(grid(side));
    std::printf("%d samples: discrepancy %.4f, of a regular grid %.4f\n", side * side, ours,
                regular);
    EXPECT_LT(ours, regular);
  }
}

// Returns the root mean square error of a pixel's coverage by straight edges at all places. The
// normals of the edges turn from `from` to `to` degrees.
double edgeError(const std::vector<Vec2f>& samples, int from, int to) {
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
        taken += nx * (double{s.x} - 0.5) + ny * (double{s.y} - 0.5) < place;
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
    const std::vector<Vec2f> ours = samplePattern(side * side), regular = grid(side);
    const double level = edgeError(ours, 80, 100), gridLevel = edgeError(regular, 80, 100);
    const double all = edgeError(ours, 0, 180), gridAll = edgeError(regular, 0, 180);

    std::printf("%d samples, edge error: nearly level %.4f, grid %.4f; all %.4f, grid %.4f\n",
                side * side, level, gridLevel, all, gridAll);

    EXPECT_LT(level, gridLevel);
    EXPECT_LT(all, 1.2 * gridAll);
  }
}

// Each sample has a column and a row of its own.
TEST(SamplePattern, NoTwoSamplesShareARowOrAColumn) {
  for (const int n : {1, 2, 7, 16, 4096}) {
    const std::vector<Vec2f> samples = samplePattern(n);
    std::vector<int> rows, columns;
    for (const Vec2f& s : samples) {
      columns.push_back(static_cast<int>(s.x * static_cast<float>(n)));
      rows.push_back(static_cast<int>(s.y * static_cast<float>(n)));
    }

    std::sort(rows.begin(), rows.end());
    std::sort(columns.begin(), columns.end());
    for (int i = 0; i < n; ++i) {
      EXPECT_EQ(rows[static_cast<std::size_t>(i)], i);
      EXPECT_EQ(columns[static_cast<std::size_t>(i)], i);
    }
  }
}

// The probe samples stand for the whole pixel: there is one in each quarter across and down.
TEST(SamplePattern, ProbeSamplesAreSpread) {
  for (const int n : {8, 16, 64, 256}) {
    const std::vector<Vec2f> samples = samplePattern(n);
    const std::vector<Vec2f> probe(samples.begin(), samples.begin() + kProbeSamples);
    std::printf("probe of %d: discrepancy %.4f\n", n, starDiscrepancy(probe));
    EXPECT_LT(starDiscrepancy(probe), starDiscrepancy(grid(2)));
  }
}

// Where radiance is linear over the pixel, the mean of the samples is the radiance at their mean
// place. The mean place of all samples is the pixel's center, and that of the probe samples is as
// near to it as the pattern allows. (The four samples nearest to the center were up to 0.14 off,
// which shifted the picture of pixels without further samples.)
TEST(SamplePattern, SamplesAreCenterd) {
  const auto aside = [](const Vec2f* samples, int n) {
    double x = 0, y = 0;
    for (int i = 0; i < n; ++i) x += double{samples[i].x} - 0.5, y += double{samples[i].y} - 0.5;
    return std::hypot(x, y) / n;
  };

  for (const int n : {2, 4, 5, 7, 8, 9, 12, 16, 24, 25, 32, 64, 256}) {
    const std::vector<Vec2f> samples = samplePattern(n);
    EXPECT_NEAR(aside(samples.data(), n), 0, 1e-6) << n;
    if (n <= kProbeSamples) continue;
    EXPECT_LE(aside(samples.data(), kProbeSamples), n < 16 ? 0.051 : 0.025) << n;
  }
}

// The first samples of any number are spread over the pixel, so that the picture does not shift
// while more are added. In the order of columns, half of the samples would be off by 0.25.
TEST(SamplePattern, TheFirstSamplesStandForThePixel) {
  for (const int n : {16, 64, 256}) {
    const std::vector<Vec2f> samples = samplePattern(n);
    double x = 0, y = 0, most = 0, mostOfHalf = 0;

    for (int k = 1; k <= n; ++k) {
      x += double{samples[static_cast<std::size_t>(k) - 1].x} - 0.5;
      y += double{samples[static_cast<std::size_t>(k) - 1].y} - 0.5;
      if (k < kProbeSamples) continue;

      most = std::max(most, std::hypot(x, y) / k);
      if (2 * k >= n) mostOfHalf = std::max(mostOfHalf, std::hypot(x, y) / k);
    }

    std::printf("of %d: the mean of the first lies up to %.4f aside, of half or more %.4f\n", n,
                most, mostOfHalf);

    EXPECT_LT(most, 0.1) << n;
    EXPECT_LT(mostOfHalf, 0.04) << n;
  }
}

TEST(SamplePattern, OneSampleIsTheCenter) {
  ASSERT_EQ(samplePattern(1).size(), 1u);
  EXPECT_EQ(samplePattern(1)[0].x, 0.5f);
  EXPECT_EQ(samplePattern(1)[0].y, 0.5f);
}

}  // namespace
}  // namespace whit::test
