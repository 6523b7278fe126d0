// Maps that are looked up with second texture coordinates: the vector pipeline against the
// reference. io/ compares the reference with closed forms (GltfCoordinates).
#include <gtest/gtest.h>

#include "render/row_of_tiles.h"

namespace whit::test {
namespace {

// Maps of all kinds are side by side, by both coordinates, with and without instances.
Scene everyMapTwice() {
  SceneBuilder builder;
  const std::int32_t color = addColors(builder);
  const std::int32_t normal = builder.add(
      makeTexture(TexelFormat::data, 2, 2,
                  {encodeDataTexel(0.8f, 0.5f, 0.9f, 1), encodeDataTexel(0.5f, 0.2f, 0.9f, 1),
                   encodeDataTexel(0.5f, 0.5f, 1, 1), encodeDataTexel(0.3f, 0.7f, 0.9f, 1)}));

  return rowOfTiles(builder, [&](int i) {
    Material m = diffuseMaterial(0.5f);
    m.diffuseMap = color;
    m.specular = Rgb(0.4f);
    m.roughness = 0.4f;
    if (i != 4) m.emission = {0.5f, 0.25f, 1};
    if (i >= 2) m.emissionMap = color;
    if (i != 3) m.normalMap = normal;
    m.emissionBySecondUvs = i % 2 == 0;
    m.normalBySecondUvs = i % 3 != 0;

    Mesh mesh = tile(builder.add(m));
    if (i == 5) mesh.secondUvs.clear();
    return mesh;
  });
}

// Materials blend or are cut, with and without the alpha of vertices. One mesh has none of it.
TEST(SecondUvs, KeepTheLawsOfMapsAsTheAlphaOfVertices) {
  SceneBuilder builder;
  const auto gray = [](float r) { return encodeDataTexel(r, r, r, 1); };
  const std::int32_t map = builder.add(
      makeTexture(TexelFormat::data, 2, 2, {gray(1), gray(0.3f), gray(0.6f), gray(0.8f)}));

  const Scene scene = rowOfTiles(builder, [&](int i) {
    Material m = diffuseMaterial(0.5f);
    m.alphaMap = map;
    m.alphaCutoff = 0.45f;
    m.alphaByVertex = i != 3;
    if (i % 2 == 0) {
      m.coverage = 0.9f;
      m.coverageMap = map;
      m.passClearTexels();
    }

    // The u of a second coordinate is what the alpha lacks of 1.
    Mesh mesh = tile(builder.add(m));
    mesh.secondUvs = {{1, 0}, {0.25f, 0}, {0, 0}, {0.5f, 0}};
    if (i == 5) mesh.secondUvs.clear();
    return mesh;
  });

  expectTheLawsOfMaps(scene);
}

// A table that no material uses changes no bit.
TEST(SecondUvs, KeepTheLawsOfMapsAndChangeNothingWhereNoMapAsksForThem) {
  Scene scene = everyMapTwice();
  expectTheLawsOfMaps(scene);
  for (Material& m : scene.materials) m.emissionBySecondUvs = m.normalBySecondUvs = false;
  const Image with = render(scene, smallOptions()).image;
  scene.secondUvs = {};
  EXPECT_EQ(firstDifference(render(scene, smallOptions()).image, with), "");
}

}  // namespace
}  // namespace whit::test
