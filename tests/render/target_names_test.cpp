// Every target that Highway's version compiles the kernels for has a name that --simd accepts.
#include <gtest/gtest.h>

#include "core/option_table.h"
#include "render/every_target.h"

namespace whit {
namespace {

// Returns the value that the option keeps.
std::string takenBySimd(const std::string& text) {
  RenderOptions options;
  setOption(options, "simd", text);
  return options.simd;
}

TEST(TargetNames, EveryTargetIsAWordOfTheOption) {
  ASSERT_FALSE(simd::availableTargets().empty());
  for (const std::string& target : simd::availableTargets()) {
    EXPECT_NO_THROW(EXPECT_EQ(takenBySimd(target), target)) << target;
  }
  EXPECT_ANY_THROW(takenBySimd("mmx"));
}

TEST(TargetNames, WhatIsAskedForRuns) {
  test::forEachTarget([](const std::string& target) { EXPECT_EQ(simd::chosenTarget(), target); });
}

}  // namespace
}  // namespace whit
