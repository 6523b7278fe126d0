// whit accuracy from the outside.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "accuracy/bars.h"
#include "accuracy/csv.h"
#include "accuracy/measurement.h"
#include "cli/run_program.h"

namespace whit::accuracy {
namespace {

using cli::runWhit;

std::string sourceFile(const std::string& name) {
  const char* source = std::getenv("WHIT_SOURCE_DIR");
  return std::string(source ? source : ".") + "/" + name;
}

// The values of an attribute; those of pictures that are within the file are left out.
std::set<std::string> valuesOf(const std::string& attribute, const std::string& text) {
  std::set<std::string> values;
  const std::string before = " " + attribute + "=\"";
  for (std::size_t at = text.find(before); at != std::string::npos; at = text.find(before, at)) {
    at += before.size();
    if (text.compare(at, 5, "data:") != 0) values.insert(text.substr(at, text.find('"', at) - at));
  }
  return values;
}

// Every link of a file leads to a file of its folder, and to an id in that. Returns how many
// different ones there are.
std::size_t expectLinksResolve(const std::string& folder, const std::string& file) {
  const std::string text = cli::readFile(folder + "/" + file);
  EXPECT_TRUE(valuesOf("src", text).empty());
  const std::set<std::string> targets = valuesOf("href", text);
  std::map<std::string, std::set<std::string>> ids;
  for (const std::string& target : targets) {
    const std::size_t hash = std::min(target.find('#'), target.size());
    const std::string page = hash == 0 ? file : target.substr(0, hash);
    EXPECT_TRUE(std::filesystem::exists(folder + "/" + page)) << file << ": " << target;
    if (!ids.contains(page)) ids[page] = valuesOf("id", cli::readFile(folder + "/" + page));
    if (hash < target.size()) {
      EXPECT_TRUE(ids[page].contains(target.substr(hash + 1))) << file << ": " << target;
    }
  }
  return targets.size();
}

std::vector<CsvRow> rowsOfScene(const std::vector<CsvRow>& rows, const std::string& scene) {
  std::vector<CsvRow> chosen;
  for (const CsvRow& row : rows) {
    if (row.at("scene") == scene) chosen.push_back(row);
  }
  return chosen;
}

// Shipped scenes of little time, with every knob: the terminal's table, the rows, the charts and
// their links.
TEST(AccuracyProgram, WhatIsSaidOfShippedScenesHolds) {
  const std::vector<std::string> scenes{"whitted", "mirrors", "matte", "glossy"};
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
  // How many are on a front depends on how busy the machine is.
  for (const CsvRow& row : rows) {
    const bool front = row.at("front") == "yes" || row.at("front_same_samples") == "yes";
    EXPECT_FALSE(front && std::stoi(row.at("rounds")) < kLeastRounds)
        << row.at("scene") << ", " << row.at("knob") << " " << row.at("value");
  }
  for (const std::string& scene : scenes) {
    EXPECT_GT(
        expectBarsFollow(cli::readFile(out + "/knobs-" + scene + ".svg"), rowsOfScene(rows, scene)),
        5u);
    EXPECT_GT(expectLinksResolve(out, "knobs-" + scene + ".svg"), 5u);
    EXPECT_GT(expectLinksResolve(out, "pareto-" + scene + ".svg"), 5u);
  }
  EXPECT_GT(expectLinksResolve(out, "report.html"), 10 * scenes.size());
}

// With no time to repeat, points have the one frame that their picture took.
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
  EXPECT_NE(outcome.out.find("tiny, 32x20"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("depth=0"), std::string::npos);
  EXPECT_NE(outcome.out.find("not swept: fresnel: nothing in the scene is transparent"),
            std::string::npos);
  const auto rows = parseCsv(cli::readFile(out + "/sweep.csv"), "sweep.csv");
  ASSERT_GE(rows.size(), 5u);
  EXPECT_EQ(rows[0].at("value"), "standard");
  EXPECT_EQ(rows[0].at("nonfinite"), "0");
  EXPECT_EQ(rows[0].at("reference_samples"), "64");
  const std::string svg = cli::readFile(out + "/pareto-tiny.svg");
  EXPECT_NE(svg.find("<title>depth=0:"), std::string::npos);

  const std::string html = cli::readFile(out + "/report.html");
  EXPECT_NE(html.find("</html>"), std::string::npos);
  EXPECT_GT(html.size(), svg.size());

  const cli::Outcome again = runWhit(words);
  EXPECT_NE(again.out.find("earlier"), std::string::npos) << again.out;
}

// Against all transport: four causes, the truth's own error, a sentence about what to choose.
TEST(AccuracyProgram, MeasuresAgainstAllTransport) {
  const cli::TemporaryFolder folder;
  const std::string scene = cli::writeTinyScene(folder), out = folder / "out";
  const std::vector<std::string> words{"accuracy",      scene,       "--out",  out,
                                       "--truth",       "transport", "--size", "24x16",
                                       "--time-budget", "1"};
  const cli::Outcome outcome = runWhit(words);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("truth: all transport, by packets"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("standard error of a pixel"), std::string::npos);
  EXPECT_NE(outcome.out.find("tiny at 24x16 pixels: in 16 ms "), std::string::npos);
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
  EXPECT_GT(number("standard", "truth_standard_error"), 0);
  EXPECT_GT(number("standard", "transport_rmse"), 0) << "the floor lights the sphere";
  EXPECT_EQ(number("indirect4", "transport_rmse"), 0);
  EXPECT_LT(number("spp=16 indirect=16", "total_rmse"), number("standard", "total_rmse"));
  EXPECT_LT(number("spp=16 indirect=16", "total_rmse"), number("indirect1", "total_rmse"));
  EXPECT_GT(expectLinksResolve(out, "causes-tiny.svg"), 1u);
  EXPECT_GT(expectLinksResolve(out, "report.html"), 5u);
  EXPECT_NE(runWhit(words).out.find("by an earlier run"), std::string::npos);
}

// Passes against the errors that it has just measured, fails against smaller ones.
TEST(AccuracyProgram, CheckTellsGrowth) {
  const cli::TemporaryFolder folder;
  const std::string scene = cli::writeTinyScene(folder), out = folder / "out";
  std::vector<std::string> words{"accuracy", scene,   "--out",         out, "--size", "24x16",
                                 "--knobs",  "depth", "--time-budget", "1"};
  ASSERT_EQ(runWhit(words).status, 0);
  std::string csv = cli::readFile(out + "/sweep.csv");
  std::ofstream(folder / "same.csv") << csv;
  words.insert(words.end(), {"--check", folder / "same.csv"});
  EXPECT_EQ(runWhit(words).status, 0);

  const auto rows = parseCsv(csv, "sweep.csv");
  const std::string error = "," + rows[0].at("total_rmse") + ",";
  ASSERT_NE(csv.find(error), std::string::npos);
  std::ofstream(folder / "smaller.csv") << csv.replace(csv.find(error), error.size(), ",1e-9,");
  words.back() = folder / "smaller.csv";
  const cli::Outcome outcome = runWhit(words);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("total_rmse was 1e-9"), std::string::npos) << outcome.err;
}

// The errors that are kept with the sources. To renew them after a change that is meant:
// whit accuracy mirrors --size 32x20 --knobs depth,cutoff,spp --out DIR, then DIR/sweep.csv.
TEST(AccuracyProgram, ErrorsOfMirrorsHaveNotGrown) {
  const cli::TemporaryFolder folder;
  const cli::Outcome outcome = runWhit({"accuracy", "mirrors", "--out", folder / "out", "--size",
                                        "32x20", "--knobs", "depth,cutoff,spp", "--time-budget",
                                        "1", "--check", sourceFile("tests/accuracy/mirrors.csv")});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
}

TEST(AccuracyProgram, WrongUsageSaysWhatWasExpected) {
  const auto status = [](std::vector<std::string> words, const std::string& said) {
    words.insert(words.begin(), "accuracy");
    const cli::Outcome outcome = runWhit(words);
    EXPECT_NE(outcome.err.find(said), std::string::npos) << outcome.err;
    return outcome.status;
  };
  const cli::TemporaryFolder folder;
  const std::string out = folder / "out";
  EXPECT_EQ(status({"mirrors"}, "--out DIR"), 2);
  EXPECT_EQ(status({"mirrors", "--out", out, "--quick", "--full"}, "exclude each other"), 2);
  EXPECT_EQ(status({"mirrors", "--out", out, "--time-budget", "-1"}, "--time-budget"), 2);
  EXPECT_EQ(status({"mirrors", "--out", out, "--truth", "life"}, "--truth"), 2);
  EXPECT_EQ(status({"mirrors", "--out", out, "--knobs", "dept"}, "did you mean 'depth'?"), 2);
  EXPECT_EQ(status({"mirrors", "--out", out, "--mode", "reference"}, "leave out --mode"), 2);
  EXPECT_EQ(status({"mirrors", "--out", out, "--check", folder / "none.csv"}, "none.csv"), 4);
}

}  // namespace
}  // namespace whit::accuracy
