#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "accuracy/report.h"
#include "accuracy/sweep_rows.h"
#include "core/error.h"
#include "has_text.h"
#include "output/report_page.h"

namespace whit::accuracy {
namespace {

Json facts() { return {{"cpu", "A \"fast\", big one"}, {"compiler", "g++"}}; }

// Two points of 10x10 pixels with errors that are easy to recognize.
SceneSweep sweepOfTwo() {
  SceneSweep sweep;
  sweep.scene = "room";
  sweep.width = sweep.height = 10;
  sweep.referenceSamples = 64;
  sweep.points.resize(2);

  Point& base = sweep.points[0];
  base.kind = PointKind::baseline;
  base.value = "standard";
  base.total.rmse = 0.25;
  base.total.flipMean = 0.02;
  base.total.psnrDb = std::numeric_limits<double>::infinity();
  base.sameSamples = ImageDifference();

  Point& depth = sweep.points[1];
  depth.knob = "depth";
  depth.value = "2";
  depth.cause = Cause::algorithm;
  depth.options.depth = 2;
  depth.total.rmse = 0.5;
  depth.total.pixelsGe1CodePct = 30;
  depth.arithmetic = ArithmeticError();
  depth.arithmetic->divergences = 3;
  return sweep;
}

std::vector<CsvRow> rowsOf(const SceneSweep& sweep) {
  return parseCsv(sweepCsv({sweep}, facts()), "sweep.csv");
}

TEST(SweepCsv, WhatIsWrittenIsRead) {
  const std::vector<CsvRow> rows = rowsOf(sweepOfTwo());
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].at("scene"), "room");
  EXPECT_EQ(rows[0].at("kind"), "baseline");
  EXPECT_EQ(rows[0].at("total_rmse"), "0.25");
  EXPECT_EQ(rows[0].at("total_psnr_db"), "inf");
  EXPECT_EQ(rows[0].at("same_samples_rmse"), "0");
  EXPECT_EQ(rows[0].at("arithmetic_rmse"), "");
  EXPECT_EQ(rows[0].at("cpu"), "A \"fast\", big one");

  EXPECT_EQ(rows[1].at("knob"), "depth");
  EXPECT_TRUE(hasText((" " + rows[1].at("options") + " "), " depth=2 "));
  EXPECT_EQ(rows[1].at("path_flips"), "3");
  EXPECT_EQ(rows[1].at("same_samples_rmse"), "");
  EXPECT_EQ(rows[1].at("cause"), "algorithm");
}

TEST(SweepCsv, ARowWithTooFewFieldsNamesItsLine) {
  try {
    parseCsv("a,b\n1,2\n3\n", "old.csv");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::badScene);
    EXPECT_TRUE(hasText(std::string(error.what()), "old.csv:3"));
  }
}

// The errors that have grown since sweepOfTwo().
std::vector<std::string> grown(const SceneSweep& now, const std::vector<std::string>& knobs = {}) {
  return grownErrors(rowsOf(sweepOfTwo()), rowsOf(now), knobs);
}

TEST(CheckErrors, TheSamePasses) { EXPECT_TRUE(grown(sweepOfTwo()).empty()); }

TEST(CheckErrors, SmallerErrorsAndOtherTimesPass) {
  SceneSweep better = sweepOfTwo();
  better.points[1].total.rmse = 0.1;
  better.points[1].timing.medianMs = 1e6;
  EXPECT_TRUE(grown(better).empty());
}

// The limit is 10 % more and the absolute slack: 0.2750 is just within, 0.2752 just beyond.
TEST(CheckErrors, GrowthBeyondTheToleranceFails) {
  SceneSweep now = sweepOfTwo();
  now.points[0].total.rmse = 0.2750;
  EXPECT_TRUE(grown(now).empty());

  now.points[0].total.rmse = 0.2752;
  ASSERT_EQ(grown(now).size(), 1u);
  EXPECT_TRUE(hasText(grown(now)[0], "total_rmse was 0.25, is 0.2752"));
}

// The limit is a tenth more than 30 %, and two of the 100 pixels: 35 %.
TEST(CheckErrors, SharesHaveTwoPixelsOfSlack) {
  SceneSweep now = sweepOfTwo();
  now.points[1].total.pixelsGe1CodePct = 34.9;
  EXPECT_TRUE(grown(now).empty());
  now.points[1].total.pixelsGe1CodePct = 35.1;
  EXPECT_EQ(grown(now).size(), 1u);
}

TEST(CheckErrors, NonFinitePixelsAndNanFail) {
  SceneSweep now = sweepOfTwo();
  now.points[0].total.nonFinite = 1;
  EXPECT_EQ(grown(now).size(), 1u);
  now = sweepOfTwo();
  now.points[0].total.rmse = std::nan("");
  EXPECT_EQ(grown(now).size(), 1u);
}

TEST(CheckErrors, MissingPointsFailUnlessTheirKnobWasLeftOut) {
  SceneSweep now = sweepOfTwo();
  now.points.pop_back();
  EXPECT_EQ(grown(now).size(), 1u);
  EXPECT_TRUE(grown(now, {"cutoff"}).empty());
}

// The rows say whether all transport is the truth and how far off that truth is. The rows of a
// sweep against the model leave those fields empty.
TEST(SweepCsv, SaysWhatTheTruthIs) {
  SceneSweep sweep = sweepOfTwo();
  EXPECT_EQ(rowsOf(sweep)[0].at("truth"), "model");
  EXPECT_EQ(rowsOf(sweep)[0].at("truth_standard_error"), "");
  EXPECT_EQ(rowsOf(sweep)[0].at("transport_flip"), "");

  sweep.transport = {8, 512, 0.002, 0.5, 0.0123, 4000};
  sweep.points[1].transport.emplace().flipMean = 0.0777;

  const CsvRow row = rowsOf(sweep)[1];
  EXPECT_EQ(row.at("truth"), "transport");
  EXPECT_EQ(row.at("truth_passes"), "8");
  EXPECT_EQ(row.at("truth_samples"), "512");
  EXPECT_EQ(row.at("truth_standard_error"), "0.002");
  EXPECT_EQ(row.at("truth_noise_flip"), "0.0123");
  EXPECT_EQ(row.at("transport_flip"), "0.0777");
  EXPECT_EQ(rowsOf(sweep)[0].at("transport_flip"), "") << "not measured";
}

TEST(CheckErrors, AnotherTruthCannotBeCompared) {
  SceneSweep now = sweepOfTwo();
  now.transport = {8, 512, 0.002, 0.5, 0.0123, 4000};
  EXPECT_FALSE(grown(now).empty());
  EXPECT_TRUE(grownErrors(rowsOf(now), rowsOf(now), {}).empty());
}

TEST(CheckErrors, AnotherReferenceCannotBeCompared) {
  SceneSweep now = sweepOfTwo();
  now.referenceSamples = 16;
  EXPECT_FALSE(grown(now).empty());
  now = sweepOfTwo();
  now.scene = "other";
  EXPECT_FALSE(grown(now).empty());
}

// RFC 4180, section 2: a carriage return would end the record for many readers.
TEST(Csv, FieldsWithSeparatorsAreQuoted) {
  for (const char* separator : {",", "\n", "\r"}) {
    const std::string text = std::string("x") + separator + "y";
    EXPECT_EQ(csvOf(Json::array({{{"a", text}}})), "a\n\"" + text + "\"\n");
  }
  EXPECT_EQ(csvOf(Json::array({{{"a", "x \"y\""}}})), "a\n\"x \"\"y\"\"\"\n");
}

}  // namespace
}  // namespace whit::accuracy
