// Kernels divide and take square roots exactly: they do not use an estimate of 1 / sqrt.
#include <gtest/gtest.h>

#include "inspect/stage_comparison.h"
#include "render/shipped_scene.h"
#include "simd/kernels.h"

namespace whit::test {
namespace {

// Each stage is compared with the scalar reference on the same input: normals, and the directions
// of mirrored rays. An estimate with a step of Newton's method would exceed the limit by a few
// ulps.
TEST(ReciprocalRoot, H53_isExactOnEveryTarget) {
  const Scene scene = load("mirrors");
  for (const std::string& target : simd::availableTargets()) {
    RenderOptions o = smallOptions();
    o.size = ImageSize{61, 37};
    o.simd = target;

    Renderer renderer(scene, o);
    int rows = 0;
    for (const StageDifference& row :
         compareStages(renderer, chooseCamera(scene, o), makeFilm(scene, o))) {
      if (row.column != "geometricNormal" && row.column != "direction") continue;
      ++rows;
      EXPECT_LE(row.worstUlp, row.limitUlp) << target << " " << row.column;
    }

    EXPECT_GE(rows, 2) << target;
  }
  simd::chooseTarget("auto");
}

}  // namespace
}  // namespace whit::test
