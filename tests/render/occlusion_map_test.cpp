// Occlusion maps: the vector pipeline against the reference, and their cost where there are none.
#include <gtest/gtest.h>

#include "render/row_of_tiles.h"

namespace whit::test {
namespace {

// The tiles are diffuse or rough, with a map by either set of coordinates and without a map.
Scene occludedTiles() {
  SceneBuilder builder;
  const std::int32_t map = builder.add(dataMap(2, {1, 0, 0.5f, 0.8f}));

  builder.sky(0.5f);
  return rowOfTiles(builder, [&](int i) {
    Material m = diffuseMaterial(0.3f);
    if (i % 2 == 0) m.specular = Rgb(0.6f);
    if (i != 3) m.occlusionMap = map;
    m.occlusionBySecondUvs = i > 3;
    return tile(builder.add(m));
  });
}

TEST(OcclusionMaps, AgreeWithTheReferenceOnEveryTarget) {
  Scene scene = occludedTiles();
  scene.ambient.occlusion = 1;
  gatherEffects(scene);
  RenderOptions o = smallOptions();
  for (const int samples : {0, 2}) {
    o.glossy = samples;
    o.ambientSamples = samples;
    expectTheReferenceOnEveryTarget(scene, o);
  }

  o.indirect = 2;
  expectTheReferenceOnEveryTarget(scene, o);
  expectBitsWhateverTheQueues(scene, o);
}

TEST(OcclusionMaps, HaveAStepWhereTheSceneHasThem) {
  Scene scene = occludedTiles();
  for (Material& m : scene.materials) m.occlusionMap = kNoTexture;
  expectStep("lookUpOcclusion", occludedTiles(), smallOptions(), {Effect::textures}, &scene);
}

}  // namespace
}  // namespace whit::test
