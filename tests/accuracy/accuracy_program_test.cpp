// whit accuracy from the outside.
#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "accuracy/sweep_rows.h"
#include "cli/run_command.h"
#include "embedded_data.h"
#include "sanitized.h"
#include "source_files.h"

namespace whit::accuracy {
namespace {

class AccuracyProgram : public cli::TinySceneTest {
 protected:
  // Runs `whit accuracy`, which must succeed, reads its rows, and returns the table that it prints.
  std::string sweep(const std::string& words) {
    const std::string table = succeed("accuracy --out out " + words).out;
    rows_ = parseCsv(bytesOf("out/sweep.csv"), "sweep.csv");
    return table;
  }

  std::vector<CsvRow> rows_;
};

void expectNarrowLines(const std::string& text) {
  std::istringstream table(text);
  for (std::string line; std::getline(table, line);) EXPECT_LE(line.size(), 100u) << line;
}

// The shipped scenes that take little time are swept with every knob. AccuracyReport and Fronts
// hold what the report says of the rows.
TEST_F(AccuracyProgram, SweepsShippedScenes) {
  const std::string seconds = kSanitized ? "0.05" : "0.5";
  expectNarrowLines(sweep("whitted glossy --size 8x6 --time-budget " + seconds));

  const Json scenes = embeddedData(bytesOf("out/report.html"))["scenes"];
  ASSERT_EQ(scenes.size(), 2u);
  EXPECT_EQ(scenes[0]["points"].size() + scenes[1]["points"].size(), rows_.size());
  for (const Json& scene : scenes) EXPECT_TRUE(scene["points"][0].contains("image_png"));
}

TEST_F(AccuracyProgram, SweepsATinyScene) {
  const std::string table =
      sweep("tiny.json --size 32x20 --knobs depth,spp,fresnel --time-budget 1");
  for (const char* said : {"tiny, 32x20", "depth=0",
                           "not swept: fresnel: not among the effects of the scene: transm"}) {
    EXPECT_TRUE(hasText(table, said));
  }

  ASSERT_GE(rows_.size(), 5u);
  EXPECT_EQ(rows_[0]["value"], "standard");
  EXPECT_EQ(rows_[0]["nonfinite"], "0");
  EXPECT_EQ(rows_[0]["reference_samples"], "64");
  EXPECT_TRUE(hasText(bytesOf("out/report.html"), "</html>"));
}

TEST_F(AccuracyProgram, LooksForThePlaceOfItsFilesFirst) {
  std::filesystem::create_directories(folder_ / "out/report.html");
  expectFailure("accuracy tiny.json --out out --size 8x8 --knobs spp --time-budget 0", 4,
                "report.html': it is a folder");
}

// A sweep against all transport has a fourth cause of errors, and states the truth's own error.
TEST_F(AccuracyProgram, MeasuresAgainstAllTransport) {
  const std::string table = sweep("tiny.json --truth transport --size 24x16 --time-budget 1");
  EXPECT_TRUE(hasText(table, "truth: all transport, by packets"));
  EXPECT_TRUE(hasText(table, "standard error of a pixel"));
  expectNarrowLines(table);

  std::map<std::string, CsvRow> rows;
  for (const CsvRow& row : rows_) {
    EXPECT_EQ(row.at("truth"), "transport");
    rows[row.at("knob") + row.at("value")] = row;
  }

  const auto number = [&](const char* point, const char* column) {
    return rows.contains(point) ? std::stod(rows.at(point).at(column)) : -1;
  };

  // With any number of paths no transport is left out, and more samples leave less error.
  EXPECT_GT(number("standard", "truth_standard_error"), 0);
  EXPECT_GT(number("standard", "transport_rmse"), 0) << "the floor lights the sphere";
  EXPECT_EQ(number("indirect4", "transport_rmse"), 0);
  EXPECT_LT(number("spp=16 indirect=16", "total_rmse"), number("standard", "total_rmse"));
  EXPECT_LT(number("spp=16 indirect=16", "total_rmse"), number("indirect1", "total_rmse"));
}

// The errors that are kept with the sources. To renew them after a change that is meant:
// whit accuracy mirrors --size 32x20 --knobs depth,cutoff,spp --reference-spp 64 --out DIR, then
// DIR/sweep.csv.
TEST_F(AccuracyProgram, ErrorsOfMirrorsHaveNotGrown) {
  sweep("mirrors --size 32x20 --knobs depth,cutoff,spp --time-budget 0 --reference-spp 64");
  const std::string kept = "tests/accuracy/mirrors.csv";
  const auto before = parseCsv(sourceText(kept), kept);
  for (const std::string& line : grownErrors(before, rows_)) {
    ADD_FAILURE() << line;
  }

  // With no time to repeat, each point has only the one frame that its picture took, and none is on
  // a front.
  for (CsvRow& row : rows_) {
    if (row["kind"] == "baseline") continue;
    EXPECT_EQ(row["frames"], "1");
    EXPECT_EQ(row["x_baseline_low"], "");
    EXPECT_EQ(row["front"], "no") << row["value"];
  }
}

}  // namespace
}  // namespace whit::accuracy
