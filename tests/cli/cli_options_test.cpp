// Option values, presets, and the parser, without running the program.
#include <gtest/gtest.h>

#include <sstream>

#include "command_line/help_text.h"
#include "command_line/parse_options.h"
#include "core/error.h"
#include "core/option_table.h"
#include "has_text.h"
#include "output/image_output.h"

namespace whit::cli {
namespace {

// The message of the usage error that `words` give; empty when they parse.
std::string usageError(const std::vector<std::string>& words) {
  CommonOptions common;
  std::vector<std::string> scenes;
  OptionList list;
  listCommonOptions(list, common);
  list.operands("SCENE", "a scene", 1, 1, scenes);
  try {
    parseOptions("test", "test", list, words);
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::usage);
    return error.what();
  }
  return "";
}

CommonOptions parsed(std::vector<std::string> words) {
  CommonOptions common;
  std::vector<std::string> scenes;
  OptionList list;
  listCommonOptions(list, common);
  list.operands("SCENE", "a scene", 1, 1, scenes);
  words.push_back("scene");
  EXPECT_TRUE(parseOptions("test", "test", list, words));
  return common;
}

TEST(Options, TakesEveryKindOfValue) {
  const RenderOptions o =
      parsed({"--size",    "640x360",        "--eye",     "-1,2.5,-3e-1", "--fov=35",
              "--crop",    "1,2,30,40",      "--packet",  "16",           "--batch",
              "frame",     "--robust",       "off",       "--effects",    "all",
              "--disable", "shadows,mirror", "--tonemap", "filmic",       "--strict"})
          .render;
  EXPECT_EQ(o.size, (ImageSize{640, 360}));
  EXPECT_EQ(o.eye, Vec3d(-1, 2.5, -0.3));
  EXPECT_EQ(o.fov, 35.0f);
  EXPECT_EQ(o.crop, (Crop{1, 2, 30, 40}));
  EXPECT_EQ(o.packet, 16);
  EXPECT_EQ(o.batch, Batch::frame);
  EXPECT_FALSE(o.robust);
  EXPECT_EQ(o.effects, EffectChoice::all);
  EXPECT_EQ(o.disable, EffectSet().with(Effect::shadows).with(Effect::mirror));
  EXPECT_EQ(o.toneCurve, ToneCurve::filmic);
  EXPECT_TRUE(o.strict);
}

TEST(Options, LaterValueWins) { EXPECT_EQ(parsed({"--spp", "2", "--spp", "4"}).render.spp, 4); }

TEST(Options, AutomaticPacketIsZero) { EXPECT_EQ(parsed({"--packet", "auto"}).render.packet, 0); }

struct BadWords {
  std::vector<std::string> words;
  std::string said;
};

TEST(Options, SaysWhatWasExpected) {
  const BadWords cases[] = {
      {{"s", "--size", "10x10x10"}, "WIDTHxHEIGHT"},
      {{"s", "--size", "65537x1"}, "65536"},
      {{"s", "--eye", "1,2,x"}, "x,y,z"},
      {{"s", "--eye", "1,2,nan"}, "x,y,z"},
      {{"s", "--eye", "1,2,inf"}, "x,y,z"},
      {{"s", "--crop", "4,0,4,9"}, "x0 < x1"},
      {{"s", "--crop", "-1,0,4,9"}, "x0 < x1"},
      {{"s", "--spp", "1.5"}, "whole number"},
      {{"s", "--depth", "65"}, "from 0 to 64"},
      {{"s", "--cutoff", "-1"}, "from 0 to 1"},
      {{"s", "--threads", "100000"}, "from 0 to 1024"},
      {{"s", "--packet", "5"}, "auto|1|4|8|16"},
      {{"s", "--mode", "packet"}, "did you mean 'packets'?"},
      {{"s", "--tonemap", "filmc"}, "did you mean 'filmic'?"},
      {{"s", "--robust", "yes"}, "on or off"},
      {{"s", "--disable", "vertexColours"}, "did you mean 'vertexColors'?"},
      {{"s", "--fov", "180"}, "from 0.001 to 179"},
      {{"s", "--sise", "10x10"}, "did you mean '--size'?"},
      {{"s", "--sise=10x10"}, "no option '--sise'"},
      {{"s", "-z"}, "no option '-z'"},
  };
  for (const BadWords& c : cases) {
    const std::string words = testing::PrintToString(c.words);
    const std::string error = usageError(c.words);
    EXPECT_TRUE(hasText(error, c.said)) << words;
  }
}

std::string helpOf(HelpTier tier, int width) {
  static CommonOptions common;
  static std::vector<std::string> scenes;
  OptionList list;
  listCommonOptions(list, common);
  list.operands("SCENE", "a scene", 1, 1, scenes);
  return helpText("test SCENE", "Tests.", list, tier, width);
}

TEST(Help, HasTheOptionsOfEveryDayFirst) {
  const std::string whole = helpOf(HelpTier::everyday, 80), all = helpOf(HelpTier::all, 80);
  const std::string brief = whole.substr(0, whole.find("What --quality"));
  for (const char* option : {"--size WxH", "--spp N", "--quality", "--quiet"}) {
    EXPECT_TRUE(hasText(brief, option));
  }
  std::size_t left = 0;
  const RenderOptions defaults;
  forEachOption(defaults, [&](const OptionSpec& spec, const auto&) {
    const std::string name = "  --" + std::string(spec.name) + " ";
    const std::string alone = "  --" + std::string(spec.name) + "\n";
    EXPECT_TRUE(all.find(name) != std::string::npos || all.find(alone) != std::string::npos)
        << name;
    EXPECT_EQ(brief.find(name) != std::string::npos, spec.everyday) << name;
    left += !spec.everyday;
  });
  EXPECT_TRUE(
      hasText(brief, "all options, " + std::to_string(left + 4) + " more"));  // and four of loading
}

TEST(Help, FitsTheTerminal) {
  for (const int width : {40, 60, 80, 120}) {
    std::istringstream lines(helpOf(HelpTier::all, width));
    for (std::string line; std::getline(lines, line);) {
      // Names, and values with bars between them, are not broken.
      if (line.find('|') == std::string::npos) {
        EXPECT_LE(line.size(), static_cast<std::size_t>(width)) << line;
      }
    }
  }
}

TEST(Help, SaysWhatThePresetsStandFor) {
  const std::string help = helpOf(HelpTier::everyday, 120);
  EXPECT_TRUE(
      hasText(help, "  reference                 --spp 16 --cutoff 1e-05 --mode reference\n"));
  EXPECT_TRUE(hasText(help, "  standard                  the defaults\n"));
  // What is said makes the same options as the preset.
  for (const QualityPreset& preset : qualityPresets()) {
    std::vector<std::string> words;
    std::istringstream said(preset.options);
    for (std::string word; said >> word;) words.push_back(word);
    RenderOptions made = parsed(words).render;
    made.quality = parsed({"--quality", preset.name}).render.quality;
    EXPECT_EQ(made, parsed({"--quality", preset.name}).render) << preset.name;
  }
}

TEST(Options, WordsAfterTwoDashesAreNoOptions) { EXPECT_EQ(usageError({"--", "--odd.json"}), ""); }

TEST(Options, EveryChoiceGoesBothWays) {
  RenderOptions options;
  const auto roundTrip = [](const auto& original, const OptionSpec& spec, const auto& field) {
    auto copy = original;
    parseValue(spec, formatValue(spec, field), copy);
    EXPECT_EQ(copy, field) << spec.name;
  };
  options.size = ImageSize{3, 4};
  options.camera = "front";
  options.eye = Vec3d{0.1, -1e-30, 3e20};
  options.at = Vec3d{0, 1, 0};
  options.up = Vec3f{0, 1, 0};
  options.fov = 1.0f / 3;
  options.ortho = 2.5f;
  options.crop = Crop{1, 2, 3, 4};
  options.disable = EffectSet::all();
  for (const Quality quality : {Quality::good, Quality::standard, Quality::reference}) {
    options.quality = quality;
    options.mode = Mode::reference;
    options.batch = Batch::frame;
    options.effects = EffectChoice::all;
    options.toneCurve = ToneCurve::reinhard;
    options.packet = 4;
    forEachOption(options, [&](const OptionSpec& spec, const auto& field) {
      roundTrip(std::decay_t<decltype(field)>{}, spec, field);
    });
  }
}

// The words of an option stand in the order of the enumeration.
TEST(Options, ChoicesAreNamedRight) {
  EXPECT_EQ(parsed({"--mode", "reference"}).render.mode, Mode::reference);
  EXPECT_EQ(parsed({"--effects", "auto"}).render.effects, EffectChoice::automatic);
  EXPECT_EQ(parsed({"--tonemap", "none"}).render.toneCurve, ToneCurve::none);
  EXPECT_EQ(parsed({"--tonemap", "reinhard"}).render.toneCurve, ToneCurve::reinhard);
  EXPECT_EQ(parsed({"--quality", "good"}).render.quality, Quality::good);
  EXPECT_EQ(parsed({"--quality", "standard"}).render.quality, Quality::standard);
  EXPECT_EQ(parsed({"--quality", "reference"}).render.quality, Quality::reference);
  EXPECT_EQ(parsed({"--batch", "tile"}).render.batch, Batch::tile);
}

TEST(Quality, StandardIsTheDefaults) {
  const RenderOptions defaults, standard = parsed({"--quality", "standard"}).render;
  EXPECT_EQ(standard.spp, defaults.spp);
  EXPECT_EQ(standard.depth, defaults.depth);
  EXPECT_EQ(standard.cutoff, defaults.cutoff);
  EXPECT_EQ(standard.shading, defaults.shading);
  EXPECT_EQ(standard.mode, defaults.mode);
}

TEST(Quality, AFormerPresetLeadsToTheNearOne) {
  EXPECT_TRUE(hasText(usageError({"--quality", "fine"}), "did you mean 'good'?"));
}

TEST(Options, OfAModelsViewAreMembersOfItsScene) {
  const CommonOptions common = parsed({"--azimuth", "-30", "--zoom", "1.25", "--ground"});
  EXPECT_EQ(common.load.settings,
            (std::vector<std::string>{"/azimuth=-30", "/zoom=1.25", "/ground=true"}));
  EXPECT_NE(usageError({"--zoom", "0"}), "");
  EXPECT_NE(usageError({"--azimuth", "left"}), "");
}

TEST(Quality, PresetsGiveWayToWhatIsGiven) {
  const RenderOptions good = parsed({"--depth", "6", "--quality", "good"}).render;
  EXPECT_EQ(good.depth, 6);
  EXPECT_EQ(good.spp, 16);
  EXPECT_EQ(good.shading.lightCutoff, 1e-3f);
  const RenderOptions reference = parsed({"--quality", "reference", "--spp", "2"}).render;
  EXPECT_EQ(reference.spp, 2);
  EXPECT_EQ(reference.depth, kDepthLimit);
  EXPECT_EQ(reference.cutoff, 1e-5f);
  EXPECT_EQ(reference.mode, Mode::reference);
}

// Everything that is left out by default.
TEST(Quality, GoodHasAllEffectsAndIsNamedFirst) {
  const RenderOptions good = parsed({"--quality", "good", "--ambient-samples", "4"}).render;
  EXPECT_GE(good.spp, 16);
  EXPECT_GT(good.glossy, 0);
  EXPECT_GT(good.lightSamples, 1);
  EXPECT_EQ(good.ambientSamples, 4);
  EXPECT_EQ(good.shading.textureFilter, TextureFilter::trilinear);
  EXPECT_EQ(qualityPresets()[0].name, "good");
}

TEST(Background, GoesBothWays) {
  EXPECT_EQ(parsed({"--background", "white"}).render.background.color,
            (std::array<std::uint8_t, 3>{255, 255, 255}));
  EXPECT_EQ(optionText(parsed({"--background", "#f80"}).render, "background"), "ff8800");
  EXPECT_EQ(optionText(parsed({"--background", "none"}).render, "background"), "transparent");
  for (const char* text : {"sky", "transparent", "ff8000", "000000"}) {
    EXPECT_EQ(optionText(parsed({"--background", text}).render, "background"), text);
  }
  for (const char* text : {"", "ffff", "ff80zz", "ff800000", "#", "Sky"}) {
    EXPECT_TRUE(hasText(usageError({"s", "--background", text}), "--background: expected")) << text;
  }
}

TEST(Frames, RangesAndNames) {
  EXPECT_EQ(parseFrameRange("7").first, 7);
  EXPECT_EQ(parseFrameRange("7").last, 7);
  EXPECT_EQ(parseFrameRange("3..12").first, 3);
  EXPECT_EQ(parseFrameRange("3..12").last, 12);
  for (const char* bad : {"", "a", "3..", "..3", "5..3", "-1..3", "1...3", "1..99999999999"}) {
    EXPECT_THROW(parseFrameRange(bad), Error) << bad;
  }
  EXPECT_EQ(frameName("a#/out-####.exr", 12), "a#/out-0012.exr");
  EXPECT_EQ(frameName("#.png", 12345), "12345.png");
  EXPECT_THROW(frameName("a#/out.exr", 1), Error);
}

}  // namespace
}  // namespace whit::cli
