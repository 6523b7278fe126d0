// --sphere-segments from the outside: an option of every command that loads a scene, and a knob of
// the sweep.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>

#include "accuracy/sweep_rows.h"
#include "cli/run_program.h"

namespace whit::accuracy {
namespace {

using cli::runWhit;

class SphereSegments : public testing::Test {
 protected:
  // A mirrored ball over a floor; `more`: members of the ball.
  std::string sceneWith(const std::string& name, const std::string& more) const {
    std::ofstream(folder_ / name) << R"({
      "whit": 1, "size": [64, 48],
      "cameras": {"front": {"eye": [0, 2, 6], "at": [0, 1, 0], "fov": 40}},
      "lights": [{"position": [3, 6, 4], "intensity": [60, 60, 60]}],
      "materials": {"floor": {"diffuse": 0.5},
                    "mirror": {"diffuse": 0.1, "mirror": 0.8}},
      "scene": [{"shape": "quad", "width": 8, "depth": 8, "material": "floor"},
                {"shape": "sphere", "radius": 1, "material": "mirror",
                 "transform": {"translate": [0, 1, 0], "scale": [1, 1.2, 0.9]})" +
                                         more + "}]}";
    return folder_ / name;
  }
  std::string rendered(const std::string& scene, const std::string& segments) const {
    const std::string file = scene + segments + ".exr";
    const cli::Outcome outcome =
        runWhit({"render", scene, "--sphere-segments", segments, "-o", file});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return file;
  }
  // Rows of sweep.csv by knob=value.
  std::map<std::string, CsvRow> swept(const std::string& scene, const std::string& segments) const {
    const std::string out = folder_ / ("out" + segments);
    const cli::Outcome outcome =
        runWhit({"accuracy", scene, "--out", out, "--size", "64x48", "--knobs", "sphere-segments",
                 "--sphere-segments", segments});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    std::map<std::string, CsvRow> rows;
    for (const CsvRow& row : parseCsv(cli::readFile(out + "/sweep.csv"), "sweep.csv")) {
      rows[row.at("kind") == "baseline" ? "baseline" : row.at("value")] = row;
    }
    return rows;
  }

  cli::TemporaryFolder folder_;
};

double numberOf(const CsvRow& row, const char* column) {
  return std::strtod(row.at(column).c_str(), nullptr);
}

// The description's own "segments", for all spheres at once.
TEST_F(SphereSegments, AreThoseOfTheScene) {
  const std::string exact = sceneWith("exact.json", ""),
                    made = sceneWith("made.json", ", \"segments\": 24");
  const auto compared = [&](const std::string& segments) {
    return runWhit({"compare", rendered(exact, segments), rendered(made, "0"), "--json", "-"}).out;
  };
  EXPECT_NE(compared("24").find("\"rmse\": 0.0,"), std::string::npos) << compared("24");
  EXPECT_EQ(compared("0").find("\"rmse\": 0.0,"), std::string::npos) << compared("0");
}

TEST_F(SphereSegments, TooFewAreRefused) {
  const cli::Outcome outcome =
      runWhit({"info", sceneWith("exact.json", ""), "--sphere-segments", "3"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("at least 4, found 3"), std::string::npos) << outcome.err;
}

TEST_F(SphereSegments, ErrorsFallWithTheirNumber) {
  const auto rows = swept(sceneWith("exact.json", ""), "0");
  double before = 1;
  for (const char* segments : {"16", "48", "192", "384"}) {
    ASSERT_TRUE(rows.contains(segments)) << segments;
    const CsvRow& row = rows.at(segments);
    EXPECT_EQ(row.at("knob"), "sphere-segments");
    EXPECT_EQ(row.at("cause"), "algorithm");
    const double error = numberOf(row, "same_samples_rmse");
    EXPECT_LT(error, before) << segments;
    before = error;
  }
  EXPECT_LT(numberOf(rows.at("baseline"), "same_samples_rmse"), 0.01 * before);
}

// Whatever the baseline is, the reference has exact spheres.
TEST_F(SphereSegments, OfTheBaselineAreErrors) {
  const std::string scene = sceneWith("exact.json", "");
  const auto exact = swept(scene, "0"), coarse = swept(scene, "16");
  EXPECT_EQ(coarse.at("baseline").at("same_samples_rmse"), exact.at("16").at("same_samples_rmse"));
  EXPECT_EQ(coarse.at("0").at("same_samples_rmse"), exact.at("baseline").at("same_samples_rmse"));
}

}  // namespace
}  // namespace whit::accuracy
