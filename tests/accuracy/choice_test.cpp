// The sentence about what to choose, against sweeps whose best points are plain to see.
#include "accuracy/choice.h"

#include <gtest/gtest.h>

#include <cmath>

namespace whit::accuracy {
namespace {

Point timedPoint(const std::string& name, double ms, double flip, double spread = 0) {
  Point point;
  point.kind = PointKind::preset;
  point.value = name;
  point.timing.rounds = point.timing.frames = 5;
  point.timing.settledMs = ms;
  point.timing.ratio = ms / 10;
  point.timing.ratioLow = (1 - spread) * ms / 10, point.timing.ratioHigh = (1 + spread) * ms / 10;
  point.total.flipMean = flip;
  return point;
}

SceneSweep roomOf(std::vector<Point> points) {
  SceneSweep sweep;
  sweep.scene = "room", sweep.width = 32, sweep.height = 20;
  sweep.points = std::move(points);
  return sweep;
}

TEST(Choice, IsTheLeastErrorWithinTheTime) {
  const SceneSweep sweep = roomOf({timedPoint("a", 10, 0.2), timedPoint("b", 90, 0.1),
                                   timedPoint("c", 95, 0.15), timedPoint("d", 5000, 0.01)});
  EXPECT_EQ(
      choiceText(sweep),
      "room at 32x20 pixels: in 16 ms choose a (FLIP 0.2000), in 100 ms b (FLIP 0.1000), in 1 s "
      "no more than that, in 10 s d (FLIP 0.0100).");
}

TEST(Choice, SaysWhereThereIsNone) {
  EXPECT_EQ(choiceText(roomOf({timedPoint("a", 500, 0.2)})),
            "room at 32x20 pixels: in 16 ms nothing that was measured, in 100 ms nothing that was "
            "measured, in 1 s choose a (FLIP 0.2000), in 10 s no more than that.");
}

// 15 ms, but perhaps 18.
TEST(Choice, CountsTheWholeSpread) {
  const SceneSweep sweep = roomOf({timedPoint("a", 10, 0.2), timedPoint("b", 15, 0.1, 0.2)});
  EXPECT_EQ(bestWithin(sweep, 16)->value, "a");
  EXPECT_EQ(bestWithin(sweep, 18.001)->value, "b");
}

TEST(Choice, OfEqualErrorsIsTheFastest) {
  const SceneSweep sweep = roomOf({timedPoint("a", 10, 0.2), timedPoint("b", 5, 0.2)});
  EXPECT_EQ(bestWithin(sweep, 16)->value, "b");
}

TEST(Choice, SaysOfATimeThatItHasNoSpread) {
  SceneSweep sweep = roomOf({timedPoint("a", 10, 0.2)});
  sweep.points[0].timing.rounds = 1;
  EXPECT_NE(choiceText(sweep).find("a (FLIP 0.2000; a time without a spread)"), std::string::npos);
}

TEST(Choice, IsNeverAnErrorThatIsNoNumber) {
  EXPECT_EQ(bestWithin(roomOf({timedPoint("a", 10, std::nan(""))}), 16), nullptr);
}

}  // namespace
}  // namespace whit::accuracy
