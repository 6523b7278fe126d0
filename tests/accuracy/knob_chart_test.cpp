// The chart of what each knob saves and breaks: which points it shows, and how long its bars are.
#include "accuracy/knob_chart.h"

#include <random>

#include "accuracy/bars.h"

namespace whit::accuracy {
namespace {

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

std::vector<std::string> chosenLabels(const SceneSweep& sweep) {
  std::vector<std::string> labels;
  for (const Point* point : chosenPoints(sweep)) labels.push_back(point->label());
  return labels;
}

using Labels = std::vector<std::string>;

TEST(KnobChart, ShowsOfEachKnobWhatSavesMostWithoutVisibleHarm) {
  EXPECT_EQ(
      chosenLabels(sweepOf({knobPoint("depth", "1", 0.1, 0.2), knobPoint("depth", "4", 0.4, 0.045),
                            knobPoint("depth", "8", 0.7, 0.041)})),
      Labels{"depth=4"});
}

TEST(KnobChart, WhereNothingSavesTheLeastErrorAndOfEqualOnesTheCheapest) {
  EXPECT_EQ(chosenLabels(sweepOf({knobPoint("spp", "2", 2, 0.03), knobPoint("spp", "4", 4, 0.02)})),
            Labels{"spp=4"});
  EXPECT_EQ(chosenLabels(
                sweepOf({knobPoint("packet", "1", 2, 0.04), knobPoint("packet", "4", 1.1, 0.04)})),
            Labels{"packet=4"});
}

// 0.9 of the time, known no better than within 0.8 to 1.1, is no saving.
TEST(KnobChart, WhatMayBeNoiseIsNoSaving) {
  SceneSweep sweep =
      sweepOf({knobPoint("bvh", "low", 0.9, 0.04), knobPoint("bvh", "high", 0.95, 0.039)});
  EXPECT_EQ(chosenLabels(sweep), Labels{"bvh=low"});
  for (Point& point : sweep.points) point.timing.ratioLow = 0.8, point.timing.ratioHigh = 1.1;
  EXPECT_EQ(chosenLabels(sweep), Labels{"bvh=high"});
}

TEST(KnobChart, ATimeOfOneFrameIsChosenOnlyWhereThereIsNoOther) {
  std::vector<Point> points{knobPoint("depth", "4", 0.4, 0.045),
                            knobPoint("depth", "8", 0.7, 0.041)};
  points[0].timing.rounds = 0;
  EXPECT_EQ(chosenLabels(sweepOf(points)), Labels{"depth=8"});
  points[1].timing.rounds = 0;
  EXPECT_EQ(chosenLabels(sweepOf(points)), Labels{"depth=4"});
}

TEST(KnobChart, PresetsComeFirstThenWhatSavesMost) {
  std::vector<Point> points{
      knobPoint("quality", "fine", 3.8, 0.02), knobPoint("depth", "8", 0.7, 0.041),
      knobPoint("cutoff", "0.004", 0.3, 0.045), knobPoint("", "spp=4 depth=2", 0.2, 0.03)};
  points[0].kind = PointKind::preset;
  points[3].kind = PointKind::joint;
  EXPECT_EQ(chosenLabels(sweepOf(points)), (Labels{"fine", "cutoff=0.004", "depth=8"}));
}

TEST(KnobChart, NoiseIsWhatHalfOfTheTimesAreKnownWithin) {
  SceneSweep sweep = sweepOf({knobPoint("a", "1", 1, 0), knobPoint("b", "1", 2, 0),
                              knobPoint("c", "1", 1, 0), knobPoint("d", "1", 1, 0)});
  sweep.points[1].timing.ratioLow = 0.98, sweep.points[1].timing.ratioHigh = 1.02;
  sweep.points[2].timing.ratioLow = 1.8, sweep.points[2].timing.ratioHigh = 2.2;
  sweep.points[3].timing.ratioLow = 0.5, sweep.points[3].timing.ratioHigh = 1.5;
  sweep.points[4].timing.rounds = 1;
  sweep.points[0].sameSamples.emplace().flipMean = 0.0015;
  EXPECT_NEAR(noiseOf(sweep).time, 0.1, 1e-12);
  EXPECT_EQ(noiseOf(sweep).error, 0.0015);
}

TEST(KnobChart, BarsHaveTheLengthsAndSignsOfTheRows) {
  std::mt19937 random(3);
  std::vector<Point> points;
  std::uniform_real_distribution<double> ratios(0.01, 2.5), flips(0, 0.12);
  for (int i = 0; i < 200; ++i)
    points.push_back(knobPoint("k" + std::to_string(i), "1", ratios(random), flips(random)));
  for (std::size_t i = 0; i < points.size(); i += 7) points[i].timing.rounds = 0;
  const SceneSweep sweep = sweepOf(points);
  const std::vector<CsvRow> rows = parseCsv(sweepCsv({sweep}, {}), "sweep.csv");
  EXPECT_EQ(expectBarsFollow(knobSvg(sweep, namedPoints(sweep), {}), rows), points.size());
}

}  // namespace
}  // namespace whit::accuracy
