// Vertex colors, emission maps of color and of radiance, and second texture coordinates: the vector
// pipeline against the reference, which oracle/ and io/ compare with closed forms
// (GltfCoordinates).
#include <gtest/gtest.h>

#include "reference/small_scenes.h"
#include "render/row_of_tiles.h"
#include "rounding.h"

namespace whit::test {
namespace {

// The square [0, 1]^2 of the floor y = 0 is seen from above; u and -z run from its first corner.
Mesh coloredFloor(std::uint32_t material) {
  Mesh mesh = tile(material);
  mesh.colors = {{1, 0.5f, 0.25f}, {0, 0.5f, 0.75f}, {0.5f, 1, 0}, {0.25f, 0.25f, 1}};
  return mesh;
}

TEST(VertexColors, OfMetalMultiplyTheHighlight) {
  Material m = blackMaterial();
  m.specular = Rgb(0.5f);

  const auto highlight = [&](VertexTint tint, bool colored) {
    m.vertexTint = tint;
    SceneBuilder builder;
    Mesh mesh = coloredFloor(builder.add(m));
    // Above a reflectance of 4 % nothing else depends on the color at normal incidence.
    mesh.colors.assign(colored ? 4 : 0, {1, 0.5f, 0.25f});
    builder.add(std::move(mesh));
    builder.description.lights = {lightAt({0.75f, 2, -0.25f}, 1)};
    return radianceBelow(builder.build(), {0.75, 1, -0.25});
  };

  const RgbD white = highlight(VertexTint::diffuse, false);
  EXPECT_GT(white.x, 0);
  expectNear(highlight(VertexTint::diffuse, true), white);
  expectNear(highlight(VertexTint::diffuseAndSpecular, true), white * RgbD{1, 0.5, 0.25}, 1e-6);
}

// Maps of color, radiance and normals by either set of coordinates, and vertices of all tints, are
// side by side, with and without instances. Some tiles lack a map, colors or second coordinates.
Scene everyMap() {
  SceneBuilder builder;
  const std::int32_t color = addColors(builder);
  const std::int32_t bright = builder.add(
      makeTexture(TexelFormat::radiance, 2, 2,
                  {encodeRadianceTexel({20, 3, 0.5f}), encodeRadianceTexel({1e-4f, 0, 2e-5f}),
                   encodeRadianceTexel({0, 7, 0}), encodeRadianceTexel({1, 1, 1.5f})}));
  const std::int32_t normal = builder.add(
      makeTexture(TexelFormat::data, 2, 2,
                  {encodeDataTexel(0.8f, 0.5f, 0.9f, 1), encodeDataTexel(0.5f, 0.2f, 0.9f, 1),
                   encodeDataTexel(0.5f, 0.5f, 1, 1), encodeDataTexel(0.3f, 0.7f, 0.9f, 1)}));

  return rowOfTiles(builder, [&](int i) {
    Material m = glossyMaterial(0.5f, i == 4 ? 0.0f : 0.4f, 0.4f);
    m.vertexTint = static_cast<VertexTint>(i % 3);
    if (i != 3) m.diffuseMap = color;

    if (i != 2) m.emission = {0.5f, 0.25f, 1};
    if (i != 5) m.emissionMap = i < 3 ? bright : color;
    if (i != 3) m.normalMap = normal;
    m.emissionBySecondUvs = i % 2 == 0;
    m.normalBySecondUvs = i % 3 != 0;

    Mesh mesh = coloredFloor(builder.add(m));
    if (i == 1) mesh.colors.clear();
    if (i == 5) mesh.secondUvs.clear();
    return mesh;
  });
}

// A table of second coordinates that no material uses changes no bit.
TEST(SurfaceMaps, KeepTheLawsOfMapsAndChangeNothingWhereNoMapAsksForThem) {
  Scene scene = everyMap();
  expectTheLawsOfMaps(scene);
  for (Material& m : scene.materials) m.emissionBySecondUvs = m.normalBySecondUvs = false;
  const Picture with = render(scene, smallOptions());
  scene.secondUvs = {};
  EXPECT_EQ(firstDifference(render(scene, smallOptions()), with), "");
}

TEST(SurfaceMaps, EachEffectLeftOutIsGoneAsInTheReference) {
  expectTheReferenceWithout(
      everyMap(), {Effect::vertexColors, Effect::emissionMaps, Effect::textures, Effect::emission});
}

// Materials blend or are cut, with and without the alpha of vertices. One mesh has none of it.
TEST(SurfaceMaps, KeepTheLawsOfMapsWithTheAlphaOfVertices) {
  SceneBuilder builder;
  const std::int32_t map = builder.add(dataMap(2, {1, 0.3f, 0.6f, 0.8f}));

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

}  // namespace
}  // namespace whit::test
