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

TEST_P(FogOfTheAir, KeepsThePipelineLaws) { expectThePipelineLaws(scene_, smallOptions()); }

TEST_P(FogOfTheAir, LeftOutShowsTheClearScene) {
  RenderOptions o = smallOptions();
  const Picture expected = render(load(GetParam()), o);
  o.disable = {Effect::fog};
  EXPECT_EQ(firstDifference(render(scene_, o), expected), "");
}

INSTANTIATE_TEST_SUITE_P(Shipped, FogOfTheAir, testing::Values("glass", "mirrors", "effects"),
                         sceneName);

}  // namespace
}  // namespace whit::test
