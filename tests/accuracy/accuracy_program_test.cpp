// whit accuracy from the outside.
#include <gtest/gtest.h>

#include <cstdlib>

#include "accuracy/csv.h"
#include "cli/run_program.h"

namespace whit::accuracy {
namespace {

using cli::runWhit;

std::string sourceFile(const std::string& name) {
  const char* source = std::getenv("WHIT_SOURCE_DIR");
  return std::string(source ? source : ".") + "/" + name;
}

TEST(AccuracyProgram, SweepsATinyScene) {
  const cli::TemporaryFolder folder;
  const std::string scene = cli::writeTinyScene(folder), out = folder / "out";
  const std::vector<std::string> words{"accuracy", scene,   "--out",   out,
                                       "--size",   "32x20", "--knobs", "depth,spp,fresnel"};
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
  EXPECT_NE(svg.find("<title>depth=0"), std::string::npos);

  const std::string html = cli::readFile(out + "/report.html");
  EXPECT_NE(html.find("</html>"), std::string::npos);
  EXPECT_GT(html.size(), svg.size());

  const cli::Outcome again = runWhit(words);
  EXPECT_NE(again.out.find("(by an earlier run)"), std::string::npos) << again.out;
}

// Passes against the errors that it has just measured, fails against smaller ones.
TEST(AccuracyProgram, CheckTellsGrowth) {
  const cli::TemporaryFolder folder;
  const std::string scene = cli::writeTinyScene(folder), out = folder / "out";
  std::vector<std::string> words{"accuracy", scene,   "--out",   out,
                                 "--size",   "24x16", "--knobs", "depth"};
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
  const cli::Outcome outcome =
      runWhit({"accuracy", "mirrors", "--out", folder / "out", "--size", "32x20", "--knobs",
               "depth,cutoff,spp", "--check", sourceFile("tests/accuracy/mirrors.csv")});
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
  EXPECT_EQ(status({"mirrors", "--out", out, "--knobs", "dept"}, "nearest: 'depth'"), 2);
  EXPECT_EQ(status({"mirrors", "--out", out, "--mode", "reference"}, "leave out --mode"), 2);
  EXPECT_EQ(status({"mirrors", "--out", out, "--check", folder / "none.csv"}, "none.csv"), 4);
}

}  // namespace
}  // namespace whit::accuracy
