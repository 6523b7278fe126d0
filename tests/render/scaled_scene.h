// Pictures of scenes at other scales.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>

#include "render/shipped_scene.h"
#include "verify/scaled_scene.h"

namespace whit::test {

using verify::scaled;

// Expects the same bits at other scales, 2^k.
inline void expectBitsAtAnyScale(const SceneDescription& description,
                                 std::initializer_list<int> scales,
                                 const RenderOptions& o = smallOptions()) {
  const Picture expected = render(repaired(description), o);
  for (const int k : scales) {
    EXPECT_EQ(firstDifference(render(repaired(scaled(description, k)), o), expected), "")
        << "2^" << k;
  }
}

}  // namespace whit::test
