// Fronts and findings of made-up sweeps whose best points are plain to see, and the front
// against its definition by brute force.
#include "accuracy/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace whit::accuracy {
namespace {

using Indices = std::vector<std::size_t>;

// A point beats another one if it is no worse in both respects and better in one.
bool beats(const CostAndError& a, const CostAndError& b) {
  return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
}

TEST(Pareto, ByHand) {
  EXPECT_EQ(paretoFront({}), Indices{});
  // The second is beaten by the first in both; the third is dearer but better.
  EXPECT_EQ(paretoFront({{1, 5}, {2, 6}, {4, 1}}), (Indices{0, 2}));
  // Equal in both: the first.
  EXPECT_EQ(paretoFront({{1, 4}, {1, 4}}), Indices{0});
}

TEST(Pareto, NotFiniteIsNeverOnTheFront) {
  const double nan = std::nan("");
  EXPECT_EQ(paretoFront({{1, nan}, {nan, 1}, {-kInfinity, 0}, {2, 3}, {1, kInfinity}}), Indices{3});
}

TEST(Pareto, AgainstTheDefinition) {
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    std::vector<CostAndError> points(1 + random() % 12);
    for (CostAndError& p : points) p = {double(random() % 6), double(random() % 6)};

    // Costs and errors are small whole numbers, so that many points are equal in one of them.
    const Indices front = paretoFront(points);
    const std::set<std::size_t> members(front.begin(), front.end());

    std::set<std::pair<double, double>> values;
    for (const auto i : indices(points)) {
      const bool beaten =
          std::ranges::any_of(points, [&](const CostAndError& q) { return beats(q, points[i]); });
      EXPECT_FALSE(beaten && members.contains(i));
      if (!beaten) values.insert({points[i].cost, points[i].error});
    }
    EXPECT_EQ(front.size(), values.size()) << "each value once";
  }
}

// The fronts are compared with brute force over the points that have a spread. Other points are on
// no front and beat no point.
TEST(Fronts, HoldOnlyPointsWhoseTimesHaveASpread) {
  std::mt19937 random(11);
  int without = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<Point> points(1 + random() % 10);
    for (Point& p : points) {
      p.timing.rounds = static_cast<int>(random() % 6);
      p.timing.steadyMs = static_cast<double>(1 + random() % 50);
      p.total.flipMean = static_cast<double>(random() % 50);
      if (random() % 2) p.sameSamples.emplace().flipMean = static_cast<double>(random() % 50);
      p.onFront = p.onFrontSameSamples = random() % 2;  // stale marks, which markFronts() replaces
    }

    markFronts(points);
    for (const Point& p : points) {
      without += !p.timing.hasSpread();

      bool beaten = false, beatenSame = false;
      for (const Point& q : points) {
        if (!q.timing.hasSpread()) continue;
        const double time = q.timing.steadyMs, ownTime = p.timing.steadyMs;
        beaten |= beats({time, q.total.flipMean}, {ownTime, p.total.flipMean});
        beatenSame |= q.sameSamples && p.sameSamples &&
                      beats({time, q.sameSamples->flipMean}, {ownTime, p.sameSamples->flipMean});
      }
      const bool timed = p.timing.rounds >= kLeastRounds;
      EXPECT_FALSE(p.onFront && (beaten || !timed));
      EXPECT_FALSE(p.onFrontSameSamples && (beatenSame || !p.sameSamples || !timed));
    }

    // There is a front if any point has a spread.
    EXPECT_EQ(std::ranges::any_of(points, &Point::onFront),
              std::ranges::any_of(points, [](const Point& p) { return p.timing.hasSpread(); }));
  }
  EXPECT_GT(without, 100) << "of which the law speaks";
}

TEST(Noise, IsTheMedianSpread) {
  // The spreads are 2 %, 10 % and 50 % of the medians; the baseline and the last point have none.
  struct Ratios {
    double low, median, high;
    int rounds = 5;
  };
  SceneSweep sweep;
  for (const Ratios& r : {Ratios{1, 1, 1}, Ratios{0.98, 1, 1.02}, Ratios{1.8, 2, 2.2},
                          Ratios{0.5, 1, 1.5}, Ratios{1, 1, 1, 1}}) {
    Timing& timing = sweep.points.emplace_back().timing;
    timing.ratioLow = r.low;
    timing.ratio = r.median;
    timing.ratioHigh = r.high;
    timing.rounds = r.rounds;
  }
  sweep.points[0].kind = PointKind::baseline;
  sweep.points[0].sameSamples.emplace().flipMean = 0.0015;

  EXPECT_NEAR(noiseOf(sweep).time, 0.1, 1e-12);
  EXPECT_EQ(noiseOf(sweep).flip, 0.0015);
}

TEST(IdleKnobs, AreGroupedByReason) {
  const auto groups = groupedByReason({{"a", "late"}, {"b", "flat"}, {"c", "late"}});
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].name, "a, c");
  EXPECT_EQ(groups[1].because, "flat");
}

}  // namespace
}  // namespace whit::accuracy
