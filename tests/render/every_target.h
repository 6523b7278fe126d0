// Every SIMD target of the machine.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "simd/kernels.h"

namespace whit::test {

// Calls visit(target) for each target, which is chosen meanwhile. Leaves the default target chosen.
template <typename Visit>
void forEachTarget(const Visit& visit) {
  for (const std::string& target : simd::availableTargets()) {
    SCOPED_TRACE(target);
    EXPECT_TRUE(simd::chooseTarget(target));
    visit(target);
  }
  simd::chooseTarget("auto");
}

}  // namespace whit::test
