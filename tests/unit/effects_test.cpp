#include "core/effects.h"

#include <gtest/gtest.h>

#include "unit/scene_builder.h"

namespace whit {
namespace {

TEST(EffectSet, AddsAndRemoves) {
  EffectSet set;
  set = set.with(Effect::mirror).with(Effect::sky);
  EXPECT_TRUE(set.has(Effect::mirror));
  EXPECT_FALSE(set.has(Effect::shadows));
  EXPECT_FALSE(set.without(Effect::mirror).has(Effect::mirror));
  EXPECT_EQ(set.without(set), EffectSet());
}

TEST(EffectSet, AllHasEveryEffectAndNoOtherBit) {
  for (int i = 0; i < kEffectCount; ++i) {
    EXPECT_TRUE(EffectSet::all().has(static_cast<Effect>(i)));
  }
  EXPECT_EQ(EffectSet::all().bits() >> kEffectCount, 0u);
}

TEST(ParseEffects, EveryNameStandsForItsBit) {
  for (int i = 0; i < kEffectCount; ++i) {
    const std::string name(kEffectNames[i].name);
    EXPECT_EQ(parseEffects(name), EffectSet().with(static_cast<Effect>(i))) << name;
  }
}

TEST(ParseEffects, ListsMayBeEmptyAndHaveGaps) {
  EXPECT_EQ(parseEffects(""), EffectSet());
  EXPECT_EQ(parseEffects("mirror,,shadows"),
            EffectSet().with(Effect::mirror).with(Effect::shadows));
}

TEST(ParseEffects, UnknownNameIsAUsageErrorWithTheNearestOne) {
  test::expectError(ExitStatus::usage, {"'shadow'", "'shadows'"},
                    [] { parseEffects("mirror,shadow"); });
}

}  // namespace
}  // namespace whit
