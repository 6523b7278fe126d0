// Option values, presets, and the parser, without running the program.
#include "command_line/help_text.h"
#include "command_line/parse_options.h"
#include "core/error.h"
#include "core/option_table.h"
#include "output/image_output.h"
#include "run_command.h"

namespace whit::cli {
namespace {

// The options that all commands have, and what they set.
struct Listed {
  Listed() {
    listCommonOptions(list, common);
    list.operands("SCENE", "a scene", 1, 1, scenes);
  }

  CommonOptions common;
  std::vector<std::string> scenes;
  OptionList list;
};

// What these words set behind the name of a scene.
CommonOptions allParsed(const std::string& line) {
  Listed listed;
  EXPECT_TRUE(parseOptions("test", "test", listed.list, split("scene " + line)));
  return listed.common;
}
RenderOptions parsed(const std::string& line) { return allParsed(line).render; }

// The message of the usage error that the words give; empty when they parse.
std::string usageError(const std::string& line) {
  try {
    allParsed(line);
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::usage);
    return error.what();
  }
  return "";
}

TEST(Options, TakesEveryKindOfValue) {
  const RenderOptions o = parsed(
      "--size 640x360 --eye -1,2.5,-3e-1 --fov=35 --crop 1,2,30,40 --packet 16 --batch frame "
      "--robust off --effects all --disable shadows,mirror --tonemap filmic --strict");
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

TEST(Options, LaterValueWins) { EXPECT_EQ(parsed("--spp 2 --spp 4").spp, 4); }

TEST(Options, AutomaticPacketIsZero) { EXPECT_EQ(parsed("--packet auto").packet, 0); }

std::string helpOf(HelpTier tier, int width) {
  const Listed listed;
  return helpText("test SCENE", "Tests.", listed.list, tier, width);
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
    const RenderOptions named = parsed("--quality " + std::string(preset.name));
    RenderOptions made = parsed(std::string(preset.options));
    made.quality = named.quality;
    EXPECT_EQ(made, named) << preset.name;
  }
}

TEST(Options, EveryChoiceGoesBothWays) {
  // TakesEveryKindOfValue holds how values are read.
  RenderOptions options = parsed(
      "--size 3x4 --camera front --eye 0.1,-1e-30,3e20 --at 0,1,0 --up 0,1,0 --fov 0.33333334 "
      "--ortho 2.5 --crop 1,2,3,4 --mode reference --batch frame --effects all --tonemap reinhard "
      "--packet 4");
  options.disable = EffectSet::all();
  const auto roundTrip = [](const auto& original, const OptionSpec& spec, const auto& field) {
    auto copy = original;
    parseValue(spec, formatValue(spec, field), copy);
    EXPECT_EQ(copy, field) << spec.name;
  };
  for (const Quality quality : {Quality::good, Quality::standard, Quality::reference}) {
    options.quality = quality;
    forEachOption(options, [&](const OptionSpec& spec, const auto& field) {
      roundTrip(std::decay_t<decltype(field)>{}, spec, field);
    });
  }
}

// The words of an option stand in the order of the enumeration.
TEST(Options, ChoicesAreNamedRight) {
  EXPECT_EQ(parsed("--mode reference").mode, Mode::reference);
  EXPECT_EQ(parsed("--effects auto").effects, EffectChoice::automatic);
  EXPECT_EQ(parsed("--tonemap none").toneCurve, ToneCurve::none);
  EXPECT_EQ(parsed("--tonemap reinhard").toneCurve, ToneCurve::reinhard);
  EXPECT_EQ(parsed("--quality good").quality, Quality::good);
  EXPECT_EQ(parsed("--quality reference").quality, Quality::reference);
  EXPECT_EQ(parsed("--batch tile").batch, Batch::tile);
}

TEST(Quality, StandardIsTheDefaults) { EXPECT_EQ(parsed("--quality standard"), RenderOptions()); }

TEST(Options, OfAModelsViewAreMembersOfItsScene) {
  EXPECT_EQ(allParsed("--azimuth -30 --zoom 1.25 --ground").load.settings,
            (Words{"/azimuth=-30", "/zoom=1.25", "/ground=true"}));
}

TEST(Quality, PresetsGiveWayToWhatIsGiven) {
  const RenderOptions good = parsed("--depth 6 --quality good");
  EXPECT_EQ(good.depth, 6);
  EXPECT_EQ(good.spp, 16);
  EXPECT_EQ(good.shading.lightCutoff, 1e-3f);
  const RenderOptions reference = parsed("--quality reference --spp 2");
  EXPECT_EQ(reference.spp, 2);
  EXPECT_EQ(reference.depth, kDepthLimit);
  EXPECT_EQ(reference.cutoff, 1e-5f);
  EXPECT_EQ(reference.mode, Mode::reference);
}

// Everything that is left out by default.
TEST(Quality, GoodHasAllEffectsAndIsNamedFirst) {
  const RenderOptions good = parsed("--quality good --ambient-samples 4");
  EXPECT_GE(good.spp, 16);
  EXPECT_GT(good.glossy, 0);
  EXPECT_GT(good.lightSamples, 1);
  EXPECT_EQ(good.ambientSamples, 4);
  EXPECT_EQ(good.shading.textureFilter, TextureFilter::trilinear);
  EXPECT_EQ(qualityPresets()[0].name, "good");
}

TEST(Background, GoesBothWays) {
  for (const auto& [text, said] : {std::pair{"sky", "sky"},
                                   {"transparent", "transparent"},
                                   {"none", "transparent"},
                                   {"ff8000", "ff8000"},
                                   {"000000", "000000"},
                                   {"#f80", "ff8800"},
                                   {"white", "ffffff"}}) {
    EXPECT_EQ(optionText(parsed("--background " + std::string(text)), "background"), said);
  }
  for (const std::string text : {"\"\"", "ffff", "ff80zz", "ff800000", "#", "Sky"}) {
    EXPECT_TRUE(hasText(usageError("--background " + text), "--background: expected")) << text;
  }
}

TEST(Frames, RangesAndNames) {
  for (const auto& [text, first, last] : {std::tuple{"7", 7, 7}, {"3..12", 3, 12}}) {
    EXPECT_EQ(parseFrameRange(text).first, first);
    EXPECT_EQ(parseFrameRange(text).last, last);
  }
  for (const char* bad : {"", "a", "3..", "..3", "5..3", "-1..3", "1...3", "1..99999999999"}) {
    EXPECT_THROW(parseFrameRange(bad), Error) << bad;
  }
  EXPECT_EQ(frameName("a#/out-####.exr", 12), "a#/out-0012.exr");
  EXPECT_EQ(frameName("#.png", 12345), "12345.png");
  EXPECT_THROW(frameName("a#/out.exr", 1), Error);
}

}  // namespace
}  // namespace whit::cli
