// whit accuracy from the outside.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <sstream>

#include "accuracy/report.h"
#include "accuracy/sweep_rows.h"
#include "cli/run_program.h"
#include "embedded_data.h"
#include "has_text.h"
#include "sanitized.h"

namespace whit::accuracy {
namespace {

using cli::runWhit;

std::string sourceFile(const std::string& name) {
  const char* source = std::getenv("WHIT_SOURCE_DIR");
  return std::string(source ? source : ".") + "/" + name;
}

// The shipped scenes that take little time are swept with every knob. The terminal's table, the
// rows and the report agree.
TEST(AccuracyProgram, WhatIsSaidOfShippedScenesHolds) {
  const std::vector<std::string> scenes{"whitted", "glossy"};
  const cli::TemporaryFolder folder;
  const std::string out = folder / "out";
  std::vector<std::string> words{"accuracy"};
  words.insert(words.end(), scenes.begin(), scenes.end());
  words.insert(words.end(), {"--out", out, "--size", "8x6", "--time-budget", "0.5"});

  const cli::Outcome outcome = runWhit(words);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::istringstream table(outcome.out);
  for (std::string line; std::getline(table, line);) EXPECT_LE(line.size(), 100u) << line;

  const auto rows = parseCsv(cli::readFile(out + "/sweep.csv"), "sweep.csv");
  // How many points are on a front depends on how busy the machine is, so only their rounds are
  // tested.
  for (const CsvRow& row : rows) {
    const bool front = row.at("front") == "yes" || row.at("front_same_samples") == "yes";
    EXPECT_FALSE(front && std::stoi(row.at("rounds")) < kLeastRounds)
        << row.at("scene") << ", " << row.at("knob") << " " << row.at("value");
  }

  // The points of the report are the rows of the CSV file, in the same order.
  const Json report = embeddedData(cli::readFile(out + "/report.html"));
  ASSERT_EQ(report["scenes"].size(), scenes.size());
  std::size_t at = 0;
  for (const Json& scene : report["scenes"]) {
    EXPECT_TRUE(scene["points"][0].contains("image_png"));
    for (const Json& point : scene["points"]) {
      ASSERT_LT(at, rows.size());
      EXPECT_EQ(point["scene"], rows[at].at("scene"));
      EXPECT_EQ(point["value"], rows[at].at("value"));
      EXPECT_NEAR(point["total_flip"].get<double>(), std::stod(rows[at].at("total_flip")), 1e-6);
      ++at;
    }
  }
  EXPECT_EQ(at, rows.size());
}

// With no time to repeat, each point has only the one frame that its picture took.
TEST(AccuracyProgram, WithoutATimeBudgetNoPointOfOneFrameIsOnAFront) {
  const cli::TemporaryFolder folder;
  const std::string scene = cli::writeTinyScene(folder), out = folder / "out";
  ASSERT_EQ(runWhit({"accuracy", scene, "--out", out, "--size", "16x10", "--knobs", "depth,spp",
                     "--time-budget", "0"})
                .status,
            0);

  const auto rows = parseCsv(cli::readFile(out + "/sweep.csv"), "sweep.csv");
  for (const CsvRow& row : rows) {
    if (row.at("kind") == "baseline") continue;
    EXPECT_EQ(row.at("frames"), "1");
    EXPECT_EQ(row.at("x_baseline_low"), "");
    EXPECT_EQ(row.at("front"), "no") << row.at("value");
  }
}

TEST(AccuracyProgram, SweepsATinyScene) {
  const cli::TemporaryFolder folder;
  const std::string scene = cli::writeTinyScene(folder), out = folder / "out";
  const std::vector<std::string> words{"accuracy",      scene,   "--out",   out,
                                       "--size",        "32x20", "--knobs", "depth,spp,fresnel",
                                       "--time-budget", "1"};

  const cli::Outcome outcome = runWhit(words);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(hasText(outcome.out, "tiny, 32x20"));
  EXPECT_TRUE(hasText(outcome.out, "depth=0"));
  EXPECT_TRUE(
      hasText(outcome.out, "not swept: fresnel: not among the effects of the scene: transm"));

  const auto rows = parseCsv(cli::readFile(out + "/sweep.csv"), "sweep.csv");
  ASSERT_GE(rows.size(), 5u);
  EXPECT_EQ(rows[0].at("value"), "standard");
  EXPECT_EQ(rows[0].at("nonfinite"), "0");
  EXPECT_EQ(rows[0].at("reference_samples"), "64");
  EXPECT_NE(cli::readFile(out + "/report.html").find("</html>"), std::string::npos);
}

// A sweep against all transport has a fourth cause of errors, and states the truth's own error.
TEST(AccuracyProgram, MeasuresAgainstAllTransport) {
  const cli::TemporaryFolder folder;
  const std::string scene = cli::writeTinyScene(folder), out = folder / "out";
  const std::vector<std::string> words{"accuracy",      scene,       "--out",  out,
                                       "--truth",       "transport", "--size", "24x16",
                                       "--time-budget", "1"};

  const cli::Outcome outcome = runWhit(words);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(hasText(outcome.out, "truth: all transport, by packets"));
  EXPECT_TRUE(hasText(outcome.out, "standard error of a pixel"));

  std::istringstream table(outcome.out);
  for (std::string line; std::getline(table, line);) EXPECT_LE(line.size(), 100u) << line;

  std::map<std::string, CsvRow> rows;
  for (const CsvRow& row : parseCsv(cli::readFile(out + "/sweep.csv"), "sweep.csv")) {
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
TEST(AccuracyProgram, ErrorsOfMirrorsHaveNotGrown) {
  const cli::TemporaryFolder folder;
  const std::string out = folder / "out", kept = sourceFile("tests/accuracy/mirrors.csv");
  const cli::Outcome outcome =
      runWhit({"accuracy", "mirrors", "--out", out, "--size", "32x20", "--knobs",
               "depth,cutoff,spp", "--time-budget", "1", "--reference-spp", "64"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;

  const auto before = parseCsv(cli::readFile(kept), kept);
  const auto now = parseCsv(cli::readFile(out + "/sweep.csv"), "sweep.csv");
  for (const std::string& line : grownErrors(before, now, {"depth", "cutoff", "spp"}))
    ADD_FAILURE() << line;
}

TEST(AccuracyProgram, WrongUsageSaysWhatWasExpected) {
  const auto status = [](std::vector<std::string> words, const std::string& said) {
    words.insert(words.begin(), "accuracy");
    const cli::Outcome outcome = runWhit(words);
    EXPECT_TRUE(hasText(outcome.err, said));
    return outcome.status;
  };

  const cli::TemporaryFolder folder;
  const std::string out = folder / "out";
  EXPECT_EQ(status({"mirrors"}, "--out DIR"), 2);
  EXPECT_EQ(status({"mirrors", "--out", out, "--time-budget", "-1"}, "--time-budget"), 2);
  EXPECT_EQ(status({"mirrors", "--out", out, "--truth", "life"}, "--truth"), 2);
  EXPECT_EQ(status({"mirrors", "--out", out, "--knobs", "dept"}, "did you mean 'depth'?"), 2);
  EXPECT_EQ(status({"mirrors", "--out", out, "--mode", "reference"}, "leave out --mode"), 2);
}

}  // namespace
}  // namespace whit::accuracy
