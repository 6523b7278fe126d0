// Fog of the air: kernels against the reference, and what the picture's bits must not depend on.
#include <gtest/gtest.h>

#include "render/pipeline_laws.h"

namespace whit::test {
namespace {

class FogOfTheAir : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    SceneDescription description = described(GetParam());
    description.fog = {{0.02f, 0.05f, 0}, {0.5f, 0.4f, 0.3f}};
    scene_ = repaired(std::move(description));
  }
  Scene scene_;
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

  const Picture expected = render(clear, o);
  o.disable = {Effect::fog};
  EXPECT_EQ(firstDifference(render(scene_, o), expected), "");
}

INSTANTIATE_TEST_SUITE_P(Shipped, FogOfTheAir, testing::Values("glass", "mirrors", "effects"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace whit::test
