// Indirect diffuse light: kernels against the reference, and what the picture's bits must not
// depend on.
#include <gtest/gtest.h>

#include "render/pipeline_laws.h"
#include "simd/kernels.h"

namespace whit::test {
namespace {

// The scenes have walls, a mirror and glass; textures, masks, coverage and instances.
class Indirect : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { scene_ = load(GetParam()); }
  void TearDown() override { simd::chooseTarget("auto"); }
  static RenderOptions options() {
    RenderOptions o = smallOptions();
    o.indirect = 3;
    o.depth = 5;
    return o;
  }
  Scene scene_;
};

TEST_P(Indirect, EveryStageAgreesWithItsReferenceOnEveryTarget) {
  RenderOptions o = options();
  o.spp = 2;
  o.depth = 3;
  o.glossy = 2;
  for (const float roulette : {0.0f, 0.5f}) {
    o.roulette = roulette;
    expectStagesAgreeOnEveryTarget(scene_, o);
  }
}

TEST_P(Indirect, PictureAgreesWithTheReference) {
  RenderOptions o = options();
  o.spp = 2;
  for (const float roulette : {0.0f, 0.3f}) {
    o.roulette = roulette;
    expectSampledPictureAgrees(scene_, o);
  }
}

TEST_P(Indirect, BitsDependOnTheSceneAlone) {
  expectBitsWhateverTheQueues(scene_, options());
  RenderOptions o = options();
  o.roulette = 0.5f;
  expectBitsWhateverTheQueues(scene_, o);
}

TEST_P(Indirect, ACropShowsTheSameNoise) {
  RenderOptions o = options();
  o.size = kSmallSize;
  const Image whole = render(scene_, o).image;
  o.crop = Crop{40, 30, 60, 41};
  const Image part = render(scene_, o).image;
  for (int y = 30; y < 41; ++y) {
    for (int x = 40; x < 60; ++x) EXPECT_EQ(part.at(x, y), whole.at(x, y)) << x << "," << y;
  }
}

TEST_P(Indirect, WithoutSamplesThereIsNoCallNoRayAndNoColumn) {
  RenderOptions o = smallOptions();
  const Picture plain = render(scene_, o);
  EXPECT_EQ(plain.stats.callsOf(simd::kAddIndirect), 0u);
  EXPECT_EQ(plain.stats.of(RayKind::indirect).rays, 0u);
  EXPECT_FALSE(Renderer(scene_, o).plan().features.has(Feature::streams));

  o.indirect = 2;
  const Picture sampled = render(scene_, o);
  EXPECT_GT(sampled.stats.callsOf(simd::kAddIndirect), 0u);
  EXPECT_GT(sampled.stats.of(RayKind::indirect).rays, sampled.stats.of(RayKind::primary).rays);

  o.disable = EffectSet().with(Effect::indirect);
  EXPECT_EQ(firstDifference(render(scene_, o).image, plain.image), "");
}

TEST_P(Indirect, RouletteTracesLessAndNeedsThePathsNumbersAlone) {
  RenderOptions o = options();
  const std::uint64_t all = render(scene_, o).stats.of(RayKind::indirect).rays;
  o.roulette = 0.5f;
  EXPECT_LT(render(scene_, o).stats.of(RayKind::indirect).rays, all);

  // Roulette draws its chances from the numbers of paths, also where no lobe is sampled.
  o.indirect = 0;
  EXPECT_TRUE(Renderer(scene_, o).plan().features.has(Feature::streams));
}

INSTANTIATE_TEST_SUITE_P(Shipped, Indirect, testing::Values("cornell", "effects"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace whit::test
