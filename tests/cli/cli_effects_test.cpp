// Effects on the command line: which are on, and what compiling their kernels in costs.
#include <algorithm>
#include <bit>

#include "core/options.h"
#include "embedded_data.h"
#include "run_command.h"

namespace whit::cli {
namespace {

class InfoEffects : public TinySceneTest {};
class AbEffects : public TinySceneTest {};
class EffectsCommand : public TinySceneTest {};

// SceneEffects has the reasons that are the scene's.
TEST_F(InfoEffects, DepthOfFieldNeedsSamples) {
  const std::string reason = "1 camera with an aperture", lacking = reason + ", but --spp is 1";
  EXPECT_TRUE(hasText(succeed("info effects").out, lacking));
  const std::string two = succeed("info effects --spp 2").out;
  EXPECT_TRUE(hasText(two, reason));
  EXPECT_FALSE(hasText(two, lacking));
}

TEST_F(AbEffects, MeasuresTheSceneTwice) {
  const Outcome table = succeed("bench tiny.json --ab-effects --frames 3");
  EXPECT_TRUE(hasText(table.out, "tiny, effects all over effects auto, medians of 3 turns"));
  for (const char* head : {"tiny, effects auto  48x32", "tiny, effects all  48x32"}) {
    EXPECT_TRUE(hasText(table.out, head));
  }
  EXPECT_TRUE(hasText(table.out, "outside Embree"));

  const Json json = jsonOf("bench tiny.json tiny.json --ab-effects --frames 1");
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

  const auto median = [&](std::size_t run) {
    return json["runs"][run]["frame_ms"]["median"].get<double>();
  };
  EXPECT_DOUBLE_EQ(json["all_over_auto"][0]["frame"].get<double>(), median(1) / median(0));
  EXPECT_GT(json["all_over_auto"][0]["outside_embree"].get<double>(), 0);
}

TEST_F(EffectsCommand, WritesATableAndAPicture) {
  const Outcome outcome = succeed("effects --out made --frames 1 --size 24x15");

  const std::string csv = bytesOf("made/effects.csv");
  // The table has a head, a line for the matte scene and one for each effect, except for its lights
  // and their shadows, for fog, which the scene has not, and for the effects that are off unless an
  // option turns them on.
  const auto kLines = std::ptrdiff_t{2} + kEffectCount - 3 -
                      std::popcount(optionalEffectsOff(RenderOptions()).bits());
  EXPECT_EQ(std::ranges::count(csv, '\n'), kLines) << csv;
  EXPECT_EQ(std::ranges::count(outcome.out, '\n'), kLines + 5) << outcome.out;

  const auto matte = storedIn("made/00-matte.png").codes;
  EXPECT_EQ(matte.size(), 24u * 15 * 3);
  EXPECT_NE(matte, storedIn("made/01-spotLights.png").codes);

  // There is a picture for each line but the head.
  const std::ptrdiff_t pictures =
      std::count_if(std::filesystem::directory_iterator(folder_ / "made"), {},
                    [](const auto& entry) { return entry.path().extension() == ".png"; });
  EXPECT_EQ(pictures, kLines - 1);
  EXPECT_TRUE(hasText(csv, "\nabsorption,"));

  const auto report = embeddedData(bytesOf("made/report.html"));
  EXPECT_EQ(report["effects"].size(), static_cast<std::size_t>(kLines - 1));
  EXPECT_EQ(report["pictures"][0], "00-matte.png");
}

TEST_F(EffectsCommand, LooksForThePlaceOfItsFilesFirst) {
  std::filesystem::create_directories(folder_ / "made/effects.csv");
  expectFailure("effects tiny.json --out made --frames 1 --size 8x8", 4,
                "effects.csv': it is a folder");
}

TEST_F(EffectsCommand, AddsOnlyWhatTheSceneHas) {
  const Outcome outcome = succeed("effects tiny.json --out . --frames 1 --quiet");
  EXPECT_TRUE(hasText(outcome.out, "+ mirror"));  // the result is not for --quiet to leave out
  EXPECT_EQ(outcome.err, "");

  const std::string csv = bytesOf("effects.csv");
  EXPECT_EQ(std::ranges::count(csv, '\n'), 2 + 2) << csv;  // smooth normals, a mirror
}

}  // namespace
}  // namespace whit::cli
