// Vertex colors and emission maps: the vector pipeline against the reference, which oracle/ and io/
// compare with closed forms.
#include <gtest/gtest.h>

#include <cmath>

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
    return radianceAlong(builder.build(), {0.75, 1, -0.25}, {0, -1, 0});
  };

  const RgbD white = highlight(VertexTint::diffuse, false);
  EXPECT_GT(white.x, 0);
  expectNear(highlight(VertexTint::diffuse, true), white);
  expectNear(highlight(VertexTint::diffuseAndSpecular, true), white * RgbD{1, 0.5, 0.25}, 1e-6);
}

// Textures of both kinds and tints of all kinds are side by side, with and without instances.
Scene everything() {
  SceneBuilder builder;
  const std::int32_t map = addColors(builder);

  return rowOfTiles(builder, [&](int i) {
    Material m = diffuseMaterial(0.5f);
    m.vertexTint = static_cast<VertexTint>(i % 3);
    if (i >= 3) m.emissionMap = map;
    if (i != 4) m.emission = {0.5f, 0.25f, 1};
    if (i % 2) m.diffuseMap = map;

    m.specular = Rgb(i == 2 ? 0.0f : 0.4f);
    m.roughness = 0.4f;
    Mesh mesh = coloredFloor(builder.add(m));
    if (i == 5) mesh.colors.clear();
    return mesh;
  });
}

TEST(SurfaceColors, KeepTheLawsOfMaps) { expectTheLawsOfMaps(everything()); }

TEST(SurfaceColors, EachEffectLeftOutIsGoneAsInTheReference) {
  expectTheReferenceWithout(everything(), {Effect::vertexColors, Effect::emissionMaps,
                                           Effect::textures, Effect::emission});
}

}  // namespace
}  // namespace whit::test
