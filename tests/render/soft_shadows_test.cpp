// Lights with a radius: kernels against the reference and an integral, and what the picture's bits
// must not depend on.
#include <gtest/gtest.h>

#include "inspect/metrics.h"
#include "penumbra.h"
#include "reference/small_scenes.h"
#include "render/pipeline_laws.h"

namespace whit::test {
namespace {

// The scenes have wide lights, point and spot, over smooth and textured surfaces, mirrors and
// glass.
class SoftShadows : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    Warnings warnings;
    SceneDescription d = loadScene(GetParam(), LoadOptions{}, warnings);
    for (Light& light : d.lights) light.radius = 0.4f;
    scene_ = Scene::finalize(std::move(d), warnings);
  }
  void TearDown() override { simd::chooseTarget("auto"); }
  static RenderOptions options() {
    RenderOptions o = smallOptions();
    o.lightSamples = 3;
    return o;
  }
  Scene scene_;
};

TEST_P(SoftShadows, EveryStageAgreesWithItsReferenceOnEveryTarget) {
  RenderOptions o = options();
  o.spp = 2;
  o.depth = 3;
  o.glossy = 2;
  expectStagesAgreeOnEveryTarget(scene_, o);
}

TEST_P(SoftShadows, PictureAgreesWithTheReference) {
  const RenderOptions o = options();
  Renderer renderer(scene_, o);
  Film packets = makeFilm(scene_, o), reference = makeFilm(scene_, o);
  const FrameStats fast = renderer.render(chooseCamera(scene_, o), packets);
  const FrameStats slow = renderer.renderReference(chooseCamera(scene_, o), reference);
  const ImageDifference d = compareImages(packets.image, reference.image);
  std::printf("%s: %.4f %% off by two codes or more, FLIP %.6f\n", GetParam().c_str(),
              d.pixelsGe2CodesPct, d.flipMean);

  // The bound is that of glossy reflections: one shadow ray in three that passes an edge on the
  // other side is visible.
  EXPECT_LE(d.pixelsGe2CodesPct, 0.5);
  EXPECT_LE(d.flipMean, 0.01);

  EXPECT_NEAR(static_cast<double>(fast.of(RayKind::shadow).rays),
              static_cast<double>(slow.of(RayKind::shadow).rays),
              1e-3 * static_cast<double>(slow.of(RayKind::shadow).rays));
}

TEST_P(SoftShadows, BitsDependOnTheSceneAlone) { expectBitsWhateverTheQueues(scene_, options()); }

TEST_P(SoftShadows, OneSampleIsThePictureOfPoints) {
  RenderOptions o = smallOptions();
  const Picture points = render(scene_, o);
  o.lightSamples = 4;
  const Picture wide = render(scene_, o);
  EXPECT_NE(firstDifference(wide.image, points.image), "");
  EXPECT_GT(wide.stats.of(RayKind::shadow).rays, 2 * points.stats.of(RayKind::shadow).rays);

  o.disable = EffectSet().with(Effect::softShadows);
  const Picture disabled = render(scene_, o);
  EXPECT_EQ(firstDifference(disabled.image, points.image), "");
  EXPECT_EQ(disabled.stats.of(RayKind::shadow).rays, points.stats.of(RayKind::shadow).rays);
}

INSTANTIATE_TEST_SUITE_P(Shipped, SoftShadows, testing::Values("whitted", "effects"),
                         [](const auto& info) { return info.param; });

// The pixels lie along x on a floor under a screen's edge. The samples of a pixel form one longer
// lattice.
TEST(SoftShadowsPicture, AnEdgeHasThePenumbraOfTheIntegral) {
  const Penumbra p;
  SceneBuilder builder;
  builder.add(floorAt(0, 100, builder.add(diffuseMaterial(static_cast<float>(p.albedo)))));

  const auto y = static_cast<float>(p.edge);
  builder.add(
      quad({-90, y, -90}, {0, y, -90}, {0, y, 90}, {-90, y, 90}, builder.add(blackMaterial())));

  Light light = lightAt({0, static_cast<float>(p.height), 0}, static_cast<float>(p.intensity));
  light.radius = static_cast<float>(p.radius);
  builder.description.lights = {light};

  Camera& camera = builder.lookFrom({0, 1.2f, 0});
  camera.up = {0, 0, -1};
  camera.orthographicHeight = 0.002f;
  const Scene scene = builder.build();

  RenderOptions o;
  o.size = ImageSize{1001, 1};
  o.lightSamples = 64;
  o.spp = 16;
  const Image image = render(scene, o).image;

  // A pixel is 0.002 wide, so its shade is that of its middle.
  for (int x = 0; x <= 1000; x += 50) {
    const double at = (x - 500) * 0.002;
    EXPECT_NEAR(double{image.at(x, 0).x}, p.radianceAt(at), 0.012 * p.unshadowedAt(at)) << at;
  }
}

}  // namespace
}  // namespace whit::test
