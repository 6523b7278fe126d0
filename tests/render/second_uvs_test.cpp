// Maps that are looked up with second texture coordinates: the reference against closed forms, and
// the vector pipeline against the reference.
#include <gtest/gtest.h>

#include "pi.h"
#include "reference/small_scenes.h"
#include "render/row_of_tiles.h"
#include "rounding.h"

namespace whit::test {
namespace {

// Red is beside black; the light is (code / 1023)^2.
std::int32_t addColumns(SceneBuilder& builder) {
  return builder.add(makeTexture(TexelFormat::color, 2, 1, {1023u, 0u}));
}

TEST(SecondUvs, AreThoseOfTheEmissionMapThatSaysSo) {
  for (const bool second : {false, true}) {
    SceneBuilder builder;
    Material m = diffuseMaterial(0.5f);
    m.emission = {4, 4, 4};
    m.diffuseMap = m.emissionMap = addColumns(builder);
    m.emissionBySecondUvs = second;
    builder.add(tile(builder.add(m)));
    builder.description.ambient = {Rgb(1.0f), Rgb(1.0f)};
    const Scene scene = builder.build();

    for (const double u : {0.25, 0.75}) {
      for (const double v : {0.25, 0.75}) {
        const double diffuse = u < 0.5 ? 0.5 : 0;
        const bool isLit = (second ? v : u) < 0.5;
        const RgbD seen = radianceAlong(scene, {u, 1, -v}, {0, -1, 0});
        EXPECT_NEAR(seen.x, diffuse + (isLit ? 4 : 0), kRounding) << second << " " << u << " " << v;
      }
    }
  }
}

// The normal leans by 45 degrees along u: towards +x, or by the second coordinates towards -z.
// Sunlight comes from +x and from above.
TEST(SecondUvs, AreTheFrameOfTheNormalMapThatSaysSo) {
  for (const bool second : {false, true}) {
    SceneBuilder builder;
    Material m = diffuseMaterial(0.5f);
    const float lean = 0.5f + 0.5f * std::sqrt(0.5f);
    m.normalMap =
        builder.add(makeTexture(TexelFormat::data, 1, 1, {encodeDataTexel(lean, 0.5f, lean, 1)}));
    m.normalBySecondUvs = second;
    builder.add(tile(builder.add(m)));
    builder.description.lights = {sun({-1, -1, 0}, 2)};

    const double x = std::round(lean * 255) / 127.5 - 1, y = 128 / 127.5 - 1;
    const Vec3d n = normalized(second ? Vec3d{-y, x, -x} : Vec3d{x, x, -y});
    const Vec3d toLight = normalized(Vec3d{1, 1, 0});
    const double wanted = 0.5 / kPi * 2 * dot(n, toLight);
    const RgbD seen = radianceAlong(builder.build(), {0.5, 1, -0.5}, {0, -1, 0});
    // The light's direction is rounded to float.
    EXPECT_NEAR(seen.x, wanted, 1e-6) << second;
  }
}

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
