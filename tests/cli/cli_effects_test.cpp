// Effects on the command line: which are on, and what compiling their kernels in costs.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

#include "cli/run_program.h"
#include "core/options.h"
#include "embedded_data.h"
#include "io/image/image_file.h"

namespace whit::cli {
namespace {

using Json = nlohmann::json;

TEST(InfoEffects, DepthOfFieldNeedsAnApertureAndSamples) {
  const auto line = [](const std::vector<std::string>& more) {
    std::vector<std::string> words{"info", "effects"};
    words.insert(words.end(), more.begin(), more.end());
    const std::string out = runWhit(words).out;
    const std::size_t begin = out.find("\n  depthOfField");
    return begin == std::string::npos ? out : out.substr(begin, out.find('\n', begin + 1) - begin);
  };

  EXPECT_NE(line({}).find("1 camera with an aperture, but --spp is 1"), std::string::npos);
  const std::string two = line({"--spp", "2"});
  EXPECT_NE(two.find("1 camera with an aperture"), std::string::npos) << two;
  EXPECT_EQ(two.find("but"), std::string::npos) << two;
  EXPECT_NE(line({"--spp", "2", "--disable", "depthOfField"}).find("disabled by --disable"),
            std::string::npos);
  EXPECT_NE(line({"--set", "/cameras/lens/aperture=0"}).find("no camera has an aperture"),
            std::string::npos);
}

TEST(AbEffects, MeasuresTheSceneTwice) {
  const TemporaryFolder folder;
  const std::string tiny = writeTinyScene(folder);
  const Outcome table = runWhit({"bench", tiny, "--ab-effects", "--frames", "3"});
  ASSERT_EQ(table.status, 0) << table.err;
  EXPECT_NE(table.out.find("tiny, effects all over effects auto, medians of 3 turns"),
            std::string::npos)
      << table.out;
  for (const char* head : {"tiny, effects auto  48x32", "tiny, effects all  48x32"}) {
    EXPECT_NE(table.out.find(head), std::string::npos) << table.out;
  }
  EXPECT_NE(table.out.find("outside Embree"), std::string::npos) << table.out;

  const Json json = Json::parse(
      runWhit({"bench", tiny, tiny, "--ab-effects", "--frames", "2", "--json", "-"}).out);
  ASSERT_EQ(json["runs"].size(), 4u);
  ASSERT_EQ(json["all_over_auto"].size(), 2u);
  for (std::size_t i = 0; i < 4; i += 2) {
    EXPECT_EQ(json["runs"][i]["name"], "effects auto");
    EXPECT_EQ(json["runs"][i + 1]["name"], "effects all");
    EXPECT_EQ(json["runs"][i]["effects_choice"], "auto");
    EXPECT_EQ(json["runs"][i + 1]["effects_choice"], "all");
    // More kernels are compiled in, but they trace the same rays.
    EXPECT_LT(json["runs"][i]["effects"].size(), json["runs"][i + 1]["effects"].size());
    EXPECT_EQ(json["runs"][i]["rays"], json["runs"][i + 1]["rays"]);
  }

  EXPECT_GT(json["all_over_auto"][0]["frame"].get<double>(), 0);
  EXPECT_GT(json["all_over_auto"][0]["outside_embree"].get<double>(), 0);
}

TEST(AbEffects, RefusesWhatDoesNotGoWithIt) {
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"--widths"}, {"--mode", "reference"}, {"--effects", "all"}}) {
    std::vector<std::string> all{"bench", "matte", "--ab-effects"};
    all.insert(all.end(), words.begin(), words.end());
    EXPECT_EQ(runWhit(all).status, 2) << words[0];
  }
}

TEST(EffectsCommand, WritesATableAndAPicture) {
  const TemporaryFolder folder;
  const Outcome outcome =
      runWhit({"effects", "--out", folder / "made", "--frames", "1", "--size", "48x30"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;

  const std::string csv = readFile(folder / "made/effects.csv");
  // The table has a head, a line for the matte scene and one for each effect, except for its lights
  // and their shadows, for fog, which the scene has not, and for the effects that are off unless an
  // option turns them on.
  const auto kLines = std::ptrdiff_t{2} + kEffectCount - 3 -
                      std::popcount(optionalEffectsOff(RenderOptions()).bits());
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), kLines) << csv;
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), kLines + 5) << outcome.out;

  const auto codes = [&](const char* name) {
    Warnings warnings;
    return readRawImage(folder / name, ImageLimits(), warnings).codes;
  };
  EXPECT_EQ(codes("made/00-matte.png").size(), 48u * 30 * 3);
  EXPECT_NE(codes("made/00-matte.png"), codes("made/01-spotLights.png"));

  // There is a picture for each line but the head.
  const std::ptrdiff_t pictures = std::count_if(
      std::filesystem::directory_iterator(folder / "made"), std::filesystem::directory_iterator(),
      [](const auto& entry) { return entry.path().extension() == ".png"; });
  EXPECT_EQ(pictures, kLines - 1);
  EXPECT_NE(csv.find("\nabsorption,"), std::string::npos) << csv;

  const auto report = embeddedData(readFile(folder / "made/report.html"));
  EXPECT_EQ(report["effects"].size(), static_cast<std::size_t>(kLines - 1));
  EXPECT_EQ(report["pictures"][0], "00-matte.png");
}

TEST(EffectsCommand, AddsOnlyWhatTheSceneHas) {
  const TemporaryFolder folder;
  const std::string tiny = writeTinyScene(folder);
  const Outcome outcome =
      runWhit({"effects", tiny, "--out", folder.path().string(), "--frames", "1"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;

  const std::string csv = readFile(folder / "effects.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 2 + 2) << csv;  // smooth normals, a mirror
}

TEST(EffectsCommand, RefusesWrongUsage) {
  EXPECT_EQ(runWhit({"effects"}).status, 2);
  EXPECT_EQ(runWhit({"effects", "--out", "x", "--disable", "sky"}).status, 2);
  EXPECT_EQ(runWhit({"effects", "--out", "x", "--mode", "reference"}).status, 2);
  EXPECT_EQ(runWhit({"effects", "--out", "/proc/no/such"}).status, 4);
  const Outcome help = runWhit({"effects", "--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_NE(help.out.find("--out DIR"), std::string::npos) << help.out;
}

}  // namespace
}  // namespace whit::cli
