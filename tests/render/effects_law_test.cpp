// A frame runs only the effects that its scene needs.
#include <gtest/gtest.h>

#include "render/pipeline_laws.h"

namespace whit::test {
namespace {

// Names a shipped scene that has the effect.
const char* sceneWith(Effect effect) {
  switch (effect) {
    case Effect::transmission:
    case Effect::absorption:
      return "glass";
    case Effect::smoothNormals:
    case Effect::alphaMasks:
    case Effect::normalMaps:
    case Effect::emission:
      return "atrium";
    case Effect::instances:
      return "landscape?triangles=20000";
    case Effect::ambientOcclusion:
    case Effect::skyImage:
    case Effect::glossyReflection:
    case Effect::blurredSky:
    case Effect::coverage:
    case Effect::emissionMaps:
    case Effect::vertexColors:
    case Effect::spotLights:
    case Effect::directionalLights:
    case Effect::depthOfField:
      return "effects";

    default:
      return "whitted";
  }
}

// The instances are neither misplaced nor partly visible but gone, as in the reference.
TEST(Instances, LeftOutAreNotThereAsInTheReference) {
  const Scene scene = load("landscape?triangles=20000");
  RenderOptions o = smallOptions();
  o.disable = EffectSet().with(Effect::instances);
  EXPECT_LE(differenceFromReference(scene, o).pixelsGe2CodesPct, 0.1);
}

class EffectLaw : public testing::TestWithParam<int> {};

TEST_P(EffectLaw, DisablingAnEffectChangesASceneThatHasIt) {
  const auto effect = static_cast<Effect>(GetParam());
  const char* name = sceneWith(effect);
  Scene scene = load(name);
  if (effect == Effect::fog) {  // no shipped scene has any
    scene.fog.density = Rgb(0.05f);
    scene.effects = scene.effects.with(effect);
  }
  ASSERT_TRUE(scene.effects.has(effect)) << name;

  // Some effects show only with options that sample them.
  RenderOptions o = smallOptions();
  if (effect == Effect::glossyReflection) o.glossy = 2;
  if (effect == Effect::softShadows) o.lightSamples = 2;
  if (effect == Effect::indirect) o.indirect = 2;
  if (effect == Effect::ambientOcclusion) o.ambientSamples = 2;
  if (effect == Effect::depthOfField) {
    o.camera = "lens";
    o.spp = 2;
  }

  const Image with = render(scene, o).image;
  o.disable = EffectSet().with(effect);
  EXPECT_NE(firstDifference(render(scene, o).image, with), "") << name;
}

INSTANTIATE_TEST_SUITE_P(All, EffectLaw, testing::Range(0, kEffectCount), [](const auto& info) {
  return std::string(kEffectNames[static_cast<std::size_t>(info.param)].name);
});

TEST(EffectLaw, MatteTracesNothingButPrimaryAndShadowRays) {
  const Scene scene = load("matte");
  const Picture p = render(scene, smallOptions());

  EXPECT_GT(p.stats.of(RayKind::primary).rays, 0u);
  EXPECT_GT(p.stats.of(RayKind::shadow).rays, 0u);
  EXPECT_EQ(p.stats.of(RayKind::reflection).rays, 0u);
  EXPECT_EQ(p.stats.of(RayKind::refraction).rays, 0u);
  EXPECT_EQ(p.stats.callsOf(Stage::addImpulses), 0u);
}

TEST(EffectLaw, WithoutShadowsEveryLightShines) {
  const Scene scene = load("matte");
  RenderOptions o = smallOptions();
  const Picture shadowed = render(scene, o);
  o.disable = EffectSet().with(Effect::shadows);
  const Picture lit = render(scene, o);
  EXPECT_EQ(lit.stats.of(RayKind::shadow).rays, 0u);

  for (std::size_t i = 0; i < lit.image.pixels.size(); ++i) {
    EXPECT_GE(lit.image.pixels[i].x, shadowed.image.pixels[i].x);
  }
}

}  // namespace
}  // namespace whit::test
