// Sampled reflections of rough surfaces: kernels against the reference, and what the picture's bits
// must not depend on.
#include <gtest/gtest.h>

#include "inspect/metrics.h"
#include "render/pipeline_laws.h"
#include "simd/kernels.h"

namespace whit::test {
namespace {

// The scenes have rough spheres; textures, masks, glass and instances.
class Glossy : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { scene_ = load(GetParam()); }
  void TearDown() override { simd::chooseTarget("auto"); }
  static RenderOptions options() {
    RenderOptions o = smallOptions();
    o.glossy = 3;
    return o;
  }
  Scene scene_;
};

TEST_P(Glossy, EveryStageAgreesWithItsReferenceOnEveryTarget) {
  RenderOptions o = options();
  o.spp = 2;
  o.depth = 3;
  expectStagesAgreeOnEveryTarget(scene_, o);
}

TEST_P(Glossy, PictureAgreesWithTheReference) {
  RenderOptions o = options();
  o.spp = 2;
  expectSampledPictureAgrees(scene_, o);
}

TEST_P(Glossy, BitsDependOnTheSceneAlone) { expectBitsWhateverTheQueues(scene_, options()); }

TEST_P(Glossy, ACropShowsTheSameNoise) {
  RenderOptions o = options();
  o.size = kSmallSize;
  const Image whole = render(scene_, o).image;
  o.crop = Crop{40, 30, 60, 41};
  const Image part = render(scene_, o).image;
  for (int y = 30; y < 41; ++y) {
    for (int x = 40; x < 60; ++x) EXPECT_EQ(part.at(x, y), whole.at(x, y)) << x << "," << y;
  }
}

TEST_P(Glossy, WithoutSamplesThereIsNoCallNoRayAndNoColumn) {
  RenderOptions o = smallOptions();
  o.disable = EffectSet().with(Effect::blurredSky);
  const Picture plain = render(scene_, o);
  EXPECT_EQ(plain.stats.callsOf(simd::kAddGlossyReflections), 0u);
  EXPECT_FALSE(Renderer(scene_, o).plan().features.has(Feature::streams));

  o.glossy = 3;
  const Picture sampled = render(scene_, o);
  EXPECT_GT(sampled.stats.callsOf(simd::kAddGlossyReflections), 0u);
  EXPECT_GT(sampled.stats.of(RayKind::reflection).rays, plain.stats.of(RayKind::reflection).rays);

  o.disable = o.disable.with(Effect::glossyReflection);
  EXPECT_EQ(firstDifference(render(scene_, o).image, plain.image), "");
}

INSTANTIATE_TEST_SUITE_P(Shipped, Glossy, testing::Values("glossy", "effects"),
                         [](const auto& info) { return info.param; });

// More samples come nearer to the picture of very many samples.
TEST(GlossyNoise, FallsWithTheNumberOfSamples) {
  const Scene scene = load("glossy");
  RenderOptions o = smallOptions();
  // The highlights of lights are rare and bright, and would dominate the error.
  o.disable = EffectSet().with(Effect::lights);
  o.glossy = 64;
  o.spp = 4;
  const Image settled = render(scene, o).image;

  double previous = 1e9;
  for (const int glossy : {1, 4, 16}) {
    o.glossy = glossy;
    const double error = compareImages(render(scene, o).image, settled).rmse;
    // Four times as many random points halve the error; points of a lattice do no worse.
    EXPECT_LT(error, 0.6 * previous) << glossy;
    previous = error;
  }
}

}  // namespace
}  // namespace whit::test
