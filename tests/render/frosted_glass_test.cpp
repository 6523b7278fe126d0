// Frosted glass: the vector pipeline against the reference, and its cost where there is none.
#include <gtest/gtest.h>

#include "render/row_of_tiles.h"

namespace whit::test {
namespace {

Material glassOf(float roughness) {
  Material m = blackMaterial();
  m.transmission = Rgb(0.9f, 1.0f, 0.8f);
  m.roughness = roughness;
  m.frosted = true;
  m.glossyReflection = m.castsShadow = false;
  return m;
}

// Solids and sheets before a lit floor: smooth and rough ones, in one another and one upon another,
// with a coat, a lobe, a color, a roughness map, and partly there.
Scene frostedThings() {
  SceneBuilder builder;
  builder.sky(1);
  builder.add(floorAt(0, 6), diffuseMaterial(0.6f));
  const std::int32_t map = builder.add(dataMap(2, {1, 0.01f, 0.5f, 0.8f}, true));

  for (int i = 0; i < 6; ++i) {
    Material m = glassOf(i == 0 ? 0.02f : 0.15f * static_cast<float>(i));
    m.ior = 1.2f + 0.2f * static_cast<float>(i);
    if (i == 1) {
      m.mirror = Rgb(0.1f);
      m.mirrorGrazing = Rgb(0.5f);
    }
    if (i == 2) {
      m.coat = true;
      m.mirror = Rgb(0.2f);
      m.mirrorGrazing = Rgb(1.0f);
    }
    if (i == 3) {
      m.specular = Rgb(0.04f);
      m.diffuse = Rgb(0.4f, 0.2f, 0.1f);
      m.transmission *= 0.5f;
    }
    if (i == 4) m.roughnessMap = map;
    const float x = static_cast<float>(i) - 2.5f;
    builder.add(box({x - 0.4f, 0.1f, -0.4f}, {x + 0.4f, 0.9f, 0.4f}), m);
    if (i == 5) {
      m.ior = 1.1f;
      builder.add(box({x - 0.2f, 0.3f, -0.2f}, {x + 0.2f, 0.6f, 0.6f}), m);
    }
  }

  // The last sheet lies on the face of a block.
  for (int i = 0; i < 4; ++i) {
    Material m = glassOf(0.3f);
    m.thin = true;
    if (i > 0) {
      m.specular = Rgb(0.04f);
      m.glossyReflection = true;
    }
    if (i == 2) m.coverage = 0.6f;
    const float x = static_cast<float>(i) - 2.5f, z = i == 3 ? 0.4f : 1.5f;
    builder.add(
        quad({x - 0.3f, 0.2f, z}, {x + 0.3f, 0.2f, z}, {x + 0.3f, 0.8f, z}, {x - 0.3f, 0.8f, z}),
        m);
  }

  builder.description.lights = {sun({0.5f, -1, -0.5f}, 2)};
  builder.lookFrom({0.3f, 1.8f, 5}, {0, 0.4f, 0});
  return builder.build();
}

RenderOptions threeSamples() {
  RenderOptions o = withSampledLobes(3);
  o.size = kSmallSize;
  return o;
}

TEST(FrostedGlass, KeepsThePipelineLaws) {
  const Scene scene = frostedThings();
  RenderOptions o = threeSamples();
  expectThePipelineLaws(scene, o);

  o.indirect = 1;
  o.shading.fresnel = FresnelModel::schlick;
  expectThePipelineLaws(scene, o);
}

// From each surface behind the first hit at most one ray is reflected and one refracted.
TEST(FrostedGlass, HasBoundedTrees) {
  RenderOptions o = threeSamples();
  o.maxRays = 100000;
  const Scene scene = frostedThings();
  for (int depth = 1; depth < 5; ++depth) {
    o.depth = depth;
    const Plan plan = makePlan(scene, o);
    for (const Step& step : plan.impulses) EXPECT_EQ(step.childrenAt(1), 1u) << step.name;
  }
}

TEST(FrostedGlass, HasAStepWhereTheSceneHasIt) {
  Scene clear = frostedThings();
  for (Material& m : clear.materials) m.frosted = false;
  expectStep("addFrostedRefractions", frostedThings(), threeSamples(), {Effect::transmission},
             &clear);
  EXPECT_EQ(makePlan(frostedThings(), smallOptions()).find("addFrostedRefractions"), nullptr);
}

}  // namespace
}  // namespace whit::test
