// Occlusion maps: the vector pipeline against the reference, and their cost where there are none.
#include <gtest/gtest.h>

#include "render/plan.h"
#include "render/row_of_tiles.h"

namespace whit::test {
namespace {

// The tiles are diffuse or rough, with a map by either set of coordinates and without a map.
Scene occludedTiles() {
  SceneBuilder builder;
  const auto red = [](float r) { return encodeDataTexel(r, 0.3f, 0.7f, 1); };
  const std::int32_t map =
      builder.add(makeTexture(TexelFormat::data, 2, 2, {red(1), red(0), red(0.5f), red(0.8f)}));

  builder.sky(0.5f);
  return rowOfTiles(builder, [&](int i) {
    Material m = diffuseMaterial(0.3f);
    if (i % 2 == 0) m.specular = Rgb(0.6f);
    if (i != 3) m.occlusionMap = map;
    m.occlusionBySecondUvs = i > 3;
    Mesh mesh = quad({0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}, builder.add(m));
    mesh.secondUvs = {{0, 1}, {0, 0}, {1, 0}, {1, 1}};
    return mesh;
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
}

TEST(OcclusionMaps, KeepTheirBitsWhateverTheQueues) {
  RenderOptions o = smallOptions();
  o.indirect = 2;
  expectBitsWhateverTheQueues(occludedTiles(), o);
}

TEST(OcclusionMaps, HaveAStepWhereTheSceneHasThem) {
  Scene scene = occludedTiles();
  EXPECT_NE(makePlan(scene, smallOptions()).find("lookUpOcclusion"), nullptr);

  RenderOptions o = smallOptions();
  o.disable = EffectSet().with(Effect::textures);
  EXPECT_EQ(makePlan(scene, o).find("lookUpOcclusion"), nullptr);

  for (Material& m : scene.materials) m.occlusionMap = kNoTexture;
  EXPECT_EQ(makePlan(scene, smallOptions()).find("lookUpOcclusion"), nullptr);
}

}  // namespace
}  // namespace whit::test
