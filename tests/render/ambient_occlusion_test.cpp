// Ambient occlusion: kernels against the reference, and what the picture's bits must not depend
// on.
#include <gtest/gtest.h>

#include "render/pipeline_laws.h"
#include "simd/kernels.h"

namespace whit::test {
namespace {

class AmbientOcclusion : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { scene_ = load(GetParam()); }
  void TearDown() override { simd::chooseTarget("auto"); }
  static RenderOptions options() {
    RenderOptions o = smallOptions();
    o.ambientSamples = 3;
    return o;
  }
  Scene scene_;
};

TEST_P(AmbientOcclusion, EveryStageAgreesWithItsReferenceOnEveryTarget) {
  RenderOptions o = options();
  o.spp = 2;
  o.depth = 3;
  for (const bool terminator : {false, true}) {
    o.shading.terminator = terminator;
    expectStagesAgreeOnEveryTarget(scene_, o);
  }
}

TEST_P(AmbientOcclusion, PictureAgreesWithTheReference) {
  expectSampledPictureAgrees(scene_, options());
}

TEST_P(AmbientOcclusion, BitsDependOnTheSceneAlone) {
  expectBitsWhateverTheQueues(scene_, options());
}

TEST_P(AmbientOcclusion, WithoutRaysThereIsNoCallAndNoColumn) {
  RenderOptions o = smallOptions();
  const Picture plain = render(scene_, o);
  EXPECT_EQ(plain.stats.callsOf(simd::kFindAmbientAndOcclusionRays), 0u);
  EXPECT_EQ(plain.stats.of(RayKind::occlusion).rays, 0u);
  EXPECT_EQ(Renderer(scene_, o).plan().find("findAmbientAndOcclusionRays"), nullptr);

  o.ambientSamples = 3;
  const Picture sampled = render(scene_, o);
  EXPECT_GT(sampled.stats.callsOf(simd::kFindAmbientAndOcclusionRays), 0u);
  EXPECT_GT(sampled.stats.of(RayKind::occlusion).rays, 0u);
  EXPECT_EQ(sampled.stats.of(RayKind::shadow).rays, plain.stats.of(RayKind::shadow).rays);

  o.disable = EffectSet().with(Effect::ambientOcclusion);
  EXPECT_EQ(firstDifference(render(scene_, o).image, plain.image), "");
}

// Surfaces that sample indirect light get no ambient light, so there is no occlusion to sample.
TEST_P(AmbientOcclusion, GoesWithAmbientLight) {
  RenderOptions o = options();
  o.depth = 0;
  const std::uint64_t alone = render(scene_, o).stats.of(RayKind::occlusion).rays;

  o.indirect = 1;
  const std::uint64_t left = render(scene_, o).stats.of(RayKind::occlusion).rays;
  EXPECT_LT(left, alone / 4);

  // The leaf of the other scene samples no indirect light (diffuseReflection), so it keeps ambient
  // light.
  EXPECT_EQ(left == 0, GetParam() == "cornell");
}

INSTANTIATE_TEST_SUITE_P(Shipped, AmbientOcclusion, testing::Values("cornell", "effects"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace whit::test
