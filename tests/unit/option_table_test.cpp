// The entries of the table of options fit the options that they describe.
#include "core/option_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "unit/scene_builder.h"

namespace whit {
namespace {

TEST(OptionTable, EachEntryIsAboutAMemberOfItsOwn) {
  const RenderOptions options;
  const char* last = nullptr;
  std::set<std::string_view> names;
  forEachOption(options, [&](const OptionSpec& spec, const auto& field) {
    const char* const place = reinterpret_cast<const char*>(&field);
    EXPECT_TRUE(!last || place > last) << spec.name;
    last = place;
    EXPECT_TRUE(names.insert(spec.name).second) << spec.name;
  });
}

// Options.EveryChoiceGoesBothWays reads the defaults.
TEST(OptionTable, CheapestWordsAreValues) {
  const RenderOptions defaults;
  RenderOptions options;
  forEachOption(defaults, [&](const OptionSpec& spec, const auto&) {
    if (spec.cheapest.empty()) return;
    EXPECT_NO_THROW(setOption(options, std::string(spec.name), std::string(spec.cheapest)))
        << spec.name;
  });
}

TEST(OptionTable, SaysWhatHasToBeMadeAnew) {
  using Words = std::vector<std::string>;
  for (const auto& [words, rebuild] :
       {std::pair{Words(), Rebuild::nothing},
        {{"size", "3x4", "fov", "30", "mode", "reference"}, Rebuild::nothing},
        {{"spp", "1"}, Rebuild::nothing},
        {{"spp", "2"}, Rebuild::frame},
        {{"bend", "off", "size", "3x4"}, Rebuild::frame},
        {{"disable", "shadows", "spp", "2"}, Rebuild::tables},
        {{"disable", "shadows", "tile", "8"}, Rebuild::workers},
        {{"robust", "off", "threads", "3"}, Rebuild::acceleration}}) {
    RenderOptions options;
    for (std::size_t i = 0; i < words.size(); i += 2) setOption(options, words[i], words[i + 1]);
    EXPECT_EQ(rebuildNeeded(RenderOptions(), options), rebuild) << testing::PrintToString(words);
  }
}

TEST(OptionTable, TakesOverNoMoreThanWasAskedFor) {
  RenderOptions from, to;
  from.camera = "front";
  from.shading.bend = false;
  from.glossy = 3;
  from.tile = 8;
  takeOver(from, Rebuild::tables, to);
  EXPECT_EQ(to.camera, "front");
  EXPECT_FALSE(to.shading.bend);
  EXPECT_EQ(to.glossy, 3);
  EXPECT_EQ(to.tile, RenderOptions().tile);
}

TEST(OptionTable, UnknownNamesNameTheNearest) {
  RenderOptions options;
  EXPECT_EQ(optionText(options, "offset"), "bound");
  test::expectError(ExitStatus::usage, {"did you mean 'depth'?"},
                    [&] { setOption(options, "dept", "3"); });
}

}  // namespace
}  // namespace whit
