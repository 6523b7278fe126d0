// The knobs against the options of the command line.
#include "accuracy/reference_pictures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "cli/run_command.h"
#include "command_line/parse_options.h"
#include "core/option_table.h"
#include "output/digest.h"
#include "unit/scene_builder.h"

namespace whit::accuracy {
namespace {

RenderOptions parsed(const std::vector<std::string>& words) {
  cli::CommonOptions common;
  cli::OptionList list;
  cli::listCommonOptions(list, common);
  std::vector<std::string> scenes;
  list.operands("SCENE", "a scene", 0, 0, scenes);
  EXPECT_TRUE(cli::parseOptions("usage", "summary", list, words));
  return common.render;
}

// LabelsAreWhatTheCommandLineTakes parses the values and what they need.
TEST(Knobs, TheTableHasValuesOfTheOptions) {
  const RenderOptions defaults;
  for (const Knob& knob : allKnobs()) {
    RenderOptions options;
    EXPECT_NO_THROW(setOption(options, knob.name, knob.exact)) << knob.name;

    const cli::Words values = cli::split(std::string(knob.spec.values));
    for (const std::string& word : cli::split(std::string(knob.spec.minor))) {
      EXPECT_EQ(std::ranges::count(values, word), 1) << knob.name << word;
    }

    // An option that only shares out the work has no error to measure.
    forEachOption(defaults, [&](const OptionSpec& spec, const auto&) {
      EXPECT_TRUE(spec.changesPicture || spec.name != knob.name) << knob.name;
    });
  }
}

// Each value does what its label says on the command line, and nothing else.
TEST(Knobs, LabelsAreWhatTheCommandLineTakes) {
  const std::string defaults = digestOf(RenderOptions());
  for (const Knob& knob : allKnobs()) {
    std::set<std::string> digests, labels;
    for (const KnobValue& value : knob.values) {
      RenderOptions options;
      value.apply(options);
      std::vector<std::string> words{"--" + knob.name, value.label};
      words.insert(words.end(), value.prerequisites.begin(), value.prerequisites.end());
      EXPECT_EQ(pictureOptions(options), pictureOptions(parsed(words)))
          << knob.name << "=" << value.label;
      digests.insert(digestOf(options));
      labels.insert(value.label);

      // A value that is applied once more changes nothing.
      const std::string once = digestOf(options);
      value.apply(options);
      EXPECT_EQ(digestOf(options), once) << knob.name << "=" << value.label;
    }

    // The values of a knob differ.
    EXPECT_EQ(digests.size(), knob.values.size()) << knob.name;
    EXPECT_EQ(labels.size(), digests.size()) << knob.name;
    EXPECT_GE(knob.values.size(), 2u) << knob.name;
    // The default of --packet is no width, so that none of its values is the default.
    EXPECT_EQ(digests.contains(defaults), knob.name != "packet") << knob.name;
  }
}

TEST(Knobs, OnlyWhatASceneHasIsSwept) {
  struct Row {
    const char* knob;
    EffectSet without, with;
  };
  const EffectSet matte{Effect::lights, Effect::shadows};
  const EffectSet mirror = matte.with(Effect::mirror), glass = matte.with(Effect::transmission);
  const EffectSet glossy = matte.with(Effect::glossy);
  for (const Row& row :
       {Row{"depth", matte, mirror}, Row{"cutoff", matte, glass}, Row{"fresnel", mirror, glass},
        Row{"glossy", glossy, glossy.with(Effect::glossyReflection)},
        Row{"light-cutoff", {}, matte}}) {
    const Knob knob = chooseKnobs({row.knob}).front();
    EXPECT_NE(knob.idle(row.without), "") << row.knob;
    EXPECT_EQ(knob.idle(row.with), "") << row.knob;
  }
  EXPECT_EQ(chooseKnobs({"spp"}).front().idle({}), "");
}

TEST(Knobs, UnknownNamesNameTheNearest) {
  EXPECT_EQ(chooseKnobs({}).size(), allKnobs().size());
  EXPECT_EQ(chooseKnobs({"cutoff", "depth"}).front().name, "depth");  // the table's order
  test::expectError(ExitStatus::usage, {"did you mean 'depth'?"}, [] { chooseKnobs({"dept"}); });
}

TEST(Knobs, TheReferenceIsExactInEverything) {
  RenderOptions options;
  for (const Knob& knob : allKnobs()) knob.values.back().apply(options);
  options.size = ImageSize{32, 20};
  const RenderOptions reference = referenceOptions(options, 256, 0);

  EXPECT_EQ(reference.mode, Mode::reference);
  EXPECT_EQ(reference.spp, 256);
  EXPECT_EQ(reference.depth, kDepthLimit);
  EXPECT_EQ(reference.cutoff, 0.0f);
  EXPECT_TRUE(reference.robust);
  EXPECT_EQ(reference.shading, ShadingChoices());
  EXPECT_EQ(reference.size, options.size);
  EXPECT_EQ(exactAtSameSamples(options, 0).spp, options.spp);
}

// Where rays branch, only a cutoff ends them.
TEST(Knobs, ExactnessKeepsACutoffWhereRaysBranch) {
  EXPECT_EQ(exactCutoff({Effect::mirror}, true), 0.0f);
  const EffectSet glass{Effect::transmission};
  EXPECT_GT(exactCutoff(glass, true), 0.0f);
  EXPECT_GT(exactCutoff(glass, false), exactCutoff(glass, true));
  EXPECT_LT(exactCutoff(glass, false), RenderOptions().cutoff);
}

// The options of the picture with all transport hold what the model's reference leaves out.
TEST(Knobs, TransportIsWhatTheModelLeavesOut) {
  EXPECT_FALSE(hasTransport({}));
  const RenderOptions some = parsed({"--spp=4", "--indirect=16"});
  EXPECT_TRUE(hasTransport(some));
  EXPECT_EQ(transportPaths(some), 64);

  const RenderOptions all = transportOptions(RenderOptions(), 32);
  EXPECT_TRUE(hasTransport(all));
  EXPECT_EQ(all.spp, 32);
  EXPECT_EQ(all.mode, Mode::packets);
  EXPECT_EQ(all.depth, kDepthLimit);
  EXPECT_EQ(all.cutoff, kTransportCutoff);

  EXPECT_FALSE(hasTransport(referenceOptions(RenderOptions(), 32, 0)));
}

}  // namespace
}  // namespace whit::accuracy
