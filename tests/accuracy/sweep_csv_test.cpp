#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "accuracy/report.h"
#include "accuracy/sweep_rows.h"
#include "has_text.h"
#include "output/report_page.h"

namespace whit::accuracy {
namespace {

Json facts() { return {{"cpu", "A \"fast\", big one"}, {"compiler", "g++"}}; }

std::vector<CsvRow> rowsOf(const SceneSweep& sweep) {
  return parseCsv(sweepCsv({sweep}, facts()), "sweep.csv");
}

void expectFields(const CsvRow& row, const CsvRow& expected) {
  for (const auto& [name, field] : expected) EXPECT_EQ(row.at(name), field) << name;
}

TEST(SweepCsv, WhatIsWrittenIsRead) {
  const std::vector<CsvRow> rows = rowsOf(madeUpSweep());
  ASSERT_EQ(rows.size(), 3u);
  expectFields(rows[0], {{"scene", "a<b & \"c\" </script>"},
                         {"kind", "baseline"},
                         {"total_rmse", "0.25"},
                         {"total_psnr_db", "inf"},
                         {"same_samples_rmse", "0"},
                         {"arithmetic_rmse", ""},
                         {"cpu", "A \"fast\", big one"}});
  expectFields(
      rows[1],
      {{"knob", "depth"}, {"path_flips", "3"}, {"same_samples_rmse", ""}, {"cause", "algorithm"}});
  EXPECT_TRUE(hasText(" " + rows[1].at("options") + " ", " depth=2 "));
}

// A change of madeUpSweep(), and how many errors have then grown.
struct Change {
  const char* what;
  void (*change)(SceneSweep&);
  std::size_t grown;
};

TEST(CheckErrors, GrowthBeyondTheToleranceFails) {
  const Change changes[] = {
      // The limit is 10 % more and the absolute slack.
      {"just within", [](SceneSweep& now) { now.points[0].total.rmse = 0.2750; }, 0},
      {"just beyond", [](SceneSweep& now) { now.points[0].total.rmse = 0.2752; }, 1},
      // The limit is a tenth more than 30 %, and two of the 100 pixels: 35 %.
      {"a share within", [](SceneSweep& now) { now.points[1].total.pixelsGe1CodePct = 34.9; }, 0},
      {"a share beyond", [](SceneSweep& now) { now.points[1].total.pixelsGe1CodePct = 35.1; }, 1},
      {"a pixel", [](SceneSweep& now) { now.points[0].total.nonFinite = 1; }, 1},
      {"NaN", [](SceneSweep& now) { now.points[0].total.rmse = std::nan(""); }, 1},
      {"a point less", [](SceneSweep& now) { now.points.pop_back(); }, 1},
      // What was measured otherwise cannot be compared: none of the three points is found again.
      {"another reference", [](SceneSweep& now) { now.referenceSamples = 16; }, 3},
  };

  const std::vector<CsvRow> before = rowsOf(madeUpSweep());
  for (const Change& change : changes) {
    SceneSweep now = madeUpSweep();
    change.change(now);
    const auto grown = grownErrors(before, rowsOf(now));
    EXPECT_EQ(grown.size(), change.grown) << change.what;
    if (change.what == std::string("just beyond")) {
      EXPECT_TRUE(hasText(grown.at(0), "total_rmse was 0.25, is 0.2752"));
    }
  }
}

// The rows say whether all transport is the truth and how far off that truth is. The rows of a
// sweep against the model leave those fields empty.
TEST(SweepCsv, SaysWhatTheTruthIs) {
  SceneSweep sweep = madeUpSweep();
  expectFields(rowsOf(sweep)[0],
               {{"truth", "model"}, {"truth_standard_error", ""}, {"transport_flip", ""}});

  sweep.transport = kTransport;
  sweep.points[1].transport.emplace().flipMean = 0.0777;

  const std::vector<CsvRow> rows = rowsOf(sweep);
  expectFields(rows[1], {{"truth", "transport"},
                         {"truth_passes", "8"},
                         {"truth_samples", "512"},
                         {"truth_standard_error", "0.002"},
                         {"truth_noise_flip", "0.0123"},
                         {"transport_flip", "0.0777"}});
  EXPECT_EQ(rows[0].at("transport_flip"), "") << "not measured";
  EXPECT_TRUE(grownErrors(rows, rows).empty());
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
