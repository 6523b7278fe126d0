// Roughness maps: the vector pipeline against the reference, and their cost where there are none.
#include <gtest/gtest.h>

#include "render/row_of_tiles.h"

namespace whit::test {
namespace {

// The tiles have lobes with maps of several sizes and without a map, and one has a mirror besides.
Scene roughTiles() {
  SceneBuilder builder;
  const std::int32_t checks = builder.add(dataMap(2, {1, 0.3f, 0.5f, 0.8f}, true));

  std::vector<float> ramp;
  for (int i = 0; i < 33 * 7; ++i) ramp.push_back(static_cast<float>(i % 33) / 32);
  Texture wide = dataMap(33, ramp, true);
  wide.wrapU = Wrap::mirror;
  const std::int32_t slope = builder.add(wide);

  return rowOfTiles(builder, [&](int i) {
    Material m = glossyMaterial(0.3f, 0.6f, i == 5 ? 1.0f : 0.7f);
    m.glossyReflection = i % 2 == 0;
    if (i == 3) m.mirror = Rgb(0.2f);
    if (i != 2) m.roughnessMap = i < 2 ? checks : slope;
    return tile(builder.add(m));
  });
}

TEST(RoughnessMaps, KeepTheLawsOfMaps) { expectTheLawsOfMaps(roughTiles(), withSampledLobes()); }

TEST(RoughnessMaps, HaveAStepWhereTheSceneHasThem) {
  Scene scene = roughTiles();
  for (Material& m : scene.materials) m.roughnessMap = kNoTexture;
  expectStep("lookUpRoughness", roughTiles(), withSampledLobes(), {Effect::textures}, &scene);
}

}  // namespace
}  // namespace whit::test
