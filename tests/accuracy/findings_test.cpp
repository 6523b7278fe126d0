// Fronts and findings of made-up sweeps whose best points are plain to see, and the front
// against its definition by brute force.
#include "accuracy/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace whit::accuracy {
namespace {

using Indices = std::vector<std::size_t>;

TEST(Pareto, ByHand) {
  EXPECT_EQ(paretoFront({}), Indices{});
  EXPECT_EQ(paretoFront({{3, 1}}), Indices{0});
  // The second is beaten by the first in both; the third is dearer but better.
  EXPECT_EQ(paretoFront({{1, 5}, {2, 6}, {4, 1}}), (Indices{0, 2}));
  // Equal cost: the better one. Equal error: the cheaper one. Equal in both: the first.
  EXPECT_EQ(paretoFront({{1, 5}, {1, 4}}), Indices{1});
  EXPECT_EQ(paretoFront({{2, 4}, {1, 4}}), Indices{1});
  EXPECT_EQ(paretoFront({{1, 4}, {1, 4}}), Indices{0});
}

TEST(Pareto, NotFiniteIsNeverOnTheFront) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  EXPECT_EQ(paretoFront({{1, nan}, {nan, 1}, {-inf, 0}, {2, 3}, {1, inf}}), Indices{3});
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
    for (std::size_t i = 0; i < points.size(); ++i) {
      bool beaten = false;
      for (const CostAndError& q : points) {
        const CostAndError& p = points[i];
        beaten |= q.cost <= p.cost && q.error <= p.error && (q.cost < p.cost || q.error < p.error);
      }
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
      p.timing.settledMs = static_cast<double>(1 + random() % 50);
      p.total.flipMean = static_cast<double>(random() % 50);
      if (random() % 2) p.sameSamples.emplace().flipMean = static_cast<double>(random() % 50);
      p.onFront = p.onFrontSameSamples = random() % 2;  // stale marks, which markFronts() replaces
    }

    markFronts(points);
    // A point beats another one if it is no worse in both respects and better in one.
    const auto beats = [](double time, double error, double otherTime, double otherError) {
      return time <= otherTime && error <= otherError && (time < otherTime || error < otherError);
    };
    for (const Point& p : points) {
      without += !p.timing.hasSpread();

      bool beaten = false, beatenSame = false;
      for (const Point& q : points) {
        if (!q.timing.hasSpread()) continue;
        beaten |= beats(q.timing.settledMs, q.total.flipMean, p.timing.settledMs, p.total.flipMean);
        beatenSame |= q.sameSamples && p.sameSamples &&
                      beats(q.timing.settledMs, q.sameSamples->flipMean, p.timing.settledMs,
                            p.sameSamples->flipMean);
      }
      EXPECT_FALSE(p.onFront && (beaten || p.timing.rounds < kLeastRounds));
      EXPECT_FALSE(p.onFrontSameSamples &&
                   (beatenSame || !p.sameSamples || p.timing.rounds < kLeastRounds));
    }

    // There is a front if any point has a spread.
    const bool timed = std::any_of(points.begin(), points.end(),
                                   [](const Point& p) { return p.timing.hasSpread(); });
    const bool front =
        std::any_of(points.begin(), points.end(), [](const Point& p) { return p.onFront; });
    EXPECT_EQ(front, timed);
  }
  EXPECT_GT(without, 100) << "of which the law speaks";
}

Point knobPoint(const std::string& knob, const std::string& value, double ratio, double flip) {
  Point point;
  point.knob = knob;
  point.value = value;
  point.timing.ratio = point.timing.ratioLow = point.timing.ratioHigh = ratio;
  point.timing.rounds = point.timing.frames = 5;
  point.total.flipMean = flip;
  return point;
}

// The baseline has a FLIP of 0.04.
SceneSweep sweepOf(const std::vector<Point>& points) {
  SceneSweep sweep;
  sweep.scene = "room";
  sweep.points.push_back(knobPoint("", "standard", 1, 0.04));
  sweep.points.front().kind = PointKind::baseline;
  sweep.points.insert(sweep.points.end(), points.begin(), points.end());
  return sweep;
}

TEST(Noise, IsTheMedianSpread) {
  SceneSweep sweep = sweepOf({knobPoint("a", "1", 1, 0), knobPoint("b", "1", 2, 0),
                              knobPoint("c", "1", 1, 0), knobPoint("d", "1", 1, 0)});
  sweep.points[1].timing.ratioLow = 0.98;
  sweep.points[1].timing.ratioHigh = 1.02;
  sweep.points[2].timing.ratioLow = 1.8;
  sweep.points[2].timing.ratioHigh = 2.2;
  sweep.points[3].timing.ratioLow = 0.5;
  sweep.points[3].timing.ratioHigh = 1.5;
  sweep.points[4].timing.rounds = 1;
  sweep.points[0].sameSamples.emplace().flipMean = 0.0015;

  // The spreads are 2 %, 10 % and 50 % of the medians; the fourth point has none.
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
