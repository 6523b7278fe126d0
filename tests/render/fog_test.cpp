// Fog of the air: kernels against the reference, and what the picture's bits must not depend on.
#include <gtest/gtest.h>

#include "render/pipeline_laws.h"

namespace whit::test {
namespace {

Scene foggy(const std::string& name, const Fog& fog) {
  SceneDescription description = described(name);
  description.fog = fog;
  return repaired(std::move(description));
}

class FogOfTheAir : public testing::TestWithParam<std::string> {
 protected:
  const Fog fog_{{0.02f, 0.05f, 0}, {0.5f, 0.4f, 0.3f}};
  const Scene scene_ = foggy(GetParam(), fog_);
};

TEST_P(FogOfTheAir, EveryStageAgreesWithItsReferenceOnEveryTarget) {
  RenderOptions o = smallOptions();
  o.depth = 3;
  expectStagesAgreeOnEveryTarget(scene_, o);
}

TEST_P(FogOfTheAir, PictureAgreesWithTheReference) {
  expectSampledPictureAgrees(scene_, smallOptions());
}

TEST_P(FogOfTheAir, BitsDependOnTheSceneAlone) {
  expectBitsWhateverTheQueues(scene_, smallOptions());
}

TEST_P(FogOfTheAir, CostsNoStepWhereThereIsNone) {
  const Scene clear = load(GetParam());
  RenderOptions o = smallOptions();
  EXPECT_NE(Renderer(scene_, o).plan().find("addFog"), nullptr);
  EXPECT_EQ(Renderer(clear, o).plan().find("addFog"), nullptr);

  const Image expected = render(clear, o).image;
  o.disable = EffectSet().with(Effect::fog);
  EXPECT_EQ(firstDifference(render(scene_, o).image, expected), "");
}

// Nothing is seen through it, so all pixels have its color, but for roundings of the weights.
TEST_P(FogOfTheAir, IsAllThatIsSeenWhereItIsDense) {
  const Scene dense = foggy(GetParam(), {Rgb(1e9f), Rgb(0.5f)});
  for (const bool packets : {false, true}) {
    for (const Rgb& pixel : render(dense, smallOptions(), packets).image.pixels) {
      EXPECT_NEAR(pixel.x, 0.5f, 1e-6f) << packets;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, FogOfTheAir, testing::Values("glass", "mirrors", "effects"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace whit::test
