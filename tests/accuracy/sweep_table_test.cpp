// The table for a terminal keeps to its width, whatever it holds.
#include <gtest/gtest.h>

#include <sstream>

#include "accuracy/points.h"
#include "accuracy/report.h"
#include "has_text.h"

namespace whit::accuracy {
namespace {

// Every value of every knob, and combinations, with numbers that take the most room.
SceneSweep widest() {
  SceneSweep sweep;
  sweep.scene = "a/long/path/to/" + std::string(60, 'x') + ".json";
  sweep.width = sweep.height = 16384;
  sweep.machine.threads = 128;
  sweep.machine.simd = "avx3_zen4";
  sweep.machine.embree = "4.3.3 avx512";
  sweep.referenceSamples = 256;
  sweep.referenceMs = 1e7;

  PointList list = makePoints(RenderOptions(), EffectSet::all(), allKnobs());
  sweep.points = std::move(list.points);
  sweep.idle = std::move(list.idle);

  for (Point& point : sweep.points) {
    // Every point is also in the list of those that were left out.
    sweep.idle.push_back({point.label(), "the minute was over"});
    Timing& t = point.timing;
    t.rounds = t.frames = 5;
    t.steadyMs = 99999.99;
    t.ratio = 9999;
    t.ratioLow = 1;
    t.ratioHigh = 19999;
    point.stats.meter.tally[0].rays = 9'999'999'999;
    point.total.flipMean = 0.99999;
    point.total.rmse = 9.9e+10;
    point.total.pixelsGe1CodePct = 100;
    point.total.nonFinite = 1'000'000;
    point.sameSamples = point.total;
    point.onFront = true;
  }
  return sweep;
}

void expectToFit(const SceneSweep& sweep) {
  std::istringstream lines(sweepTable(sweep, 4294967295u));
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line); ++count)
    EXPECT_LE(line.size(), kTableColumns) << line;
  EXPECT_GT(count, sweep.points.size());
}

TEST(SweepTable, FitsAHundredColumns) {
  expectToFit(widest());
  EXPECT_EQ(kTableColumns, 100u);
}

// The times are those of a machine so busy that frames of microseconds take seconds.
TEST(SweepTable, TimesThatSayNothingTakeNoMoreRoom) {
  SceneSweep wild = widest();
  for (Point& point : wild.points) {
    Timing& t = point.timing;
    t.ratio = 1.26e7;
    t.ratioLow = 1e-5;
    t.ratioHigh = 1e12;
  }
  expectToFit(wild);

  for (Point& point : wild.points) point.timing.ratio = 0.01;
  expectToFit(wild);
  EXPECT_TRUE(hasText(sweepTable(wild, 1), " >1e4~"));
}

TEST(SweepTable, HasARowAPointAndItsWords) {
  const SceneSweep sweep = widest();
  const std::string table = sweepTable(sweep, 1);
  for (const Point& point : sweep.points) {
    if (point.kind == PointKind::joint) continue;
    EXPECT_TRUE(hasText(table, "\n" + point.label())) << point.label();
  }

  const auto at = [&](const char* word) { return table.find(word); };
  for (const char* word : {"RMSE: root of the mean squared", "step of an 8-bit sRGB"})
    EXPECT_LT(at(word), at(sweep.points.front().label().c_str())) << word << " is before the rows";
}

TEST(SweepTable, ATimeOfOneFrameHasNoSpread) {
  SceneSweep sweep = widest();
  EXPECT_FALSE(hasText(sweepTable(sweep, 1), "    ? "));
  sweep.points[1].timing.rounds = 0;
  EXPECT_TRUE(hasText(sweepTable(sweep, 1), "    ? "));
}

}  // namespace
}  // namespace whit::accuracy
