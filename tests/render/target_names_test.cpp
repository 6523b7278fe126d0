// Every target that Highway's version compiles the kernels for has a name that --simd accepts.
#include <gtest/gtest.h>

#include "core/option_table.h"
#include "simd/kernels.h"

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
  for (const std::string& target : simd::availableTargets()) {
    EXPECT_TRUE(simd::chooseTarget(target)) << target;
    EXPECT_EQ(simd::chosenTarget(), target);
  }
  simd::chooseTarget("auto");
}

}  // namespace
}  // namespace whit
