// Vertex colors and emission maps: the reference against closed forms, and the vector pipeline
// against the reference.
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

RgbD seenAt(const Scene& scene, double u, double v, EffectSet effects = EffectSet::all()) {
  reference::Settings settings = uncut();
  settings.effects = effects;
  return radianceAlong(scene, {u, 1, -v}, {0, -1, 0}, settings);
}

// With ambient light of 1 the surface shows its diffuse color.
Scene ambientScene(const Material& material) {
  SceneBuilder builder;
  builder.add(coloredFloor(builder.add(material)));
  builder.description.ambient = {Rgb(1.0f), Rgb(1.0f)};
  return builder.build();
}

TEST(VertexColors, AreInterpolatedAndMultiplyTheDiffuseColor) {
  const Scene scene = ambientScene(diffuseMaterial(0.5f));

  // In the first triangle, of corners 0, 1 and 2, the weights are 1 - u, u - v and v.
  const double u = 0.75, v = 0.25;
  expectNear(seenAt(scene, u, v),
             RgbD{0.25 + 0.5 * 0.25, 0.125 + 0.25 + 0.25, 0.0625 + 0.375} * 0.5);
  expectNear(seenAt(scene, u, v, EffectSet::all().without(Effect::vertexColors)), RgbD(0.5));
}

TEST(VertexColors, OfWhatIsUnlitMultiplyTheEmissionAlone) {
  Material m = diffuseMaterial(0.5f);
  m.emission = Rgb(2.0f);
  m.vertexTint = VertexTint::emission;
  const RgbD color{0.25 + 0.5 * 0.25, 0.125 + 0.25 + 0.25, 0.0625 + 0.375};
  expectNear(seenAt(ambientScene(m), 0.75, 0.25), RgbD(0.5) + color * 2.0);

  m.vertexTint = VertexTint::diffuse;
  expectNear(seenAt(ambientScene(m), 0.75, 0.25), RgbD(2.0) + color * 0.5);
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
    return seenAt(builder.build(), 0.75, 0.25);
  };

  const RgbD white = highlight(VertexTint::diffuse, false);
  EXPECT_GT(white.x, 0);
  expectNear(highlight(VertexTint::diffuse, true), white);
  expectNear(highlight(VertexTint::diffuseAndSpecular, true), white * RgbD{1, 0.5, 0.25}, 1e-6);
}

// Two texels are side by side, red and dark gray; the light is (code / 1023)^2.
TEST(EmissionMap, MultipliesTheEmission) {
  SceneBuilder builder;
  Material m = blackMaterial();
  m.emission = {4, 8, 8};
  m.emissionMap =
      builder.add(makeTexture(TexelFormat::color, 2, 1, {1023u, 341u | 341u << 10 | 341u << 20}));
  builder.add(tile(builder.add(m)));
  const Scene scene = builder.build();

  expectNear(seenAt(scene, 0.25, 0.5), {4, 0, 0});
  expectNear(seenAt(scene, 0.75, 0.5), RgbD{4, 8, 8} / 9.0);
  expectNear(seenAt(scene, 0.25, 0.5, EffectSet::all().without(Effect::emissionMaps)), {4, 8, 8});
  expectNear(seenAt(scene, 0.25, 0.5, EffectSet::all().without(Effect::emission)), {});
}

// Textures of both kinds and tints of all kinds are side by side, with and without instances.
Scene everything() {
  SceneBuilder builder;
  const std::int32_t map = builder.add(makeTexture(
      TexelFormat::color, 2, 2, {1023u, 700u << 10 | 300u, 341u | 341u << 10 | 341u << 20, 900u}));

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
