// Mirrors and transmission by maps and vertex colors: the reference against closed forms, and the
// vector pipeline against the reference.
#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "reference/fresnel.h"
#include "render/plan.h"
#include "render/row_of_tiles.h"
#include "rounding.h"

namespace whit::test {
namespace {

// The map is white to the left and (1/4, 0, 1) to the right.
std::int32_t addHalves(SceneBuilder& builder) {
  return builder.add(makeTexture(TexelFormat::color, 2, 1,
                                 {encodeColorTexel(Rgb(1.0f)), encodeColorTexel({0.25f, 0, 1})}));
}

// The square [0, 1]^2 of the floor, whose vertices may have colors. The sky is 2.
Scene squareOf(SceneBuilder& builder, const Material& material, bool tinted = false) {
  Mesh mesh = tile(builder.add(material));
  if (tinted) mesh.colors = {{1, 1, 1}, {0.5f, 1, 0}, {0.5f, 1, 0}, {1, 1, 1}};
  builder.add(mesh);
  builder.sky(2);
  return builder.build();
}

RgbD reflectedAt(const Scene& scene, double x, double degrees = 0) {
  const Vec3d way = steep(degrees);
  return radianceAlong(scene, Vec3d{x, 0, -0.5} - way, way);
}

void expectColor(const RgbD& got, const RgbD& wanted) {
  constexpr double kTexel = 1e-3;  // ten bits of a color's root
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(got[i], wanted[i], kTexel) << i;
}

TEST(MirrorMaps, MultiplyTheReflectedRayAtNormalIncidence) {
  SceneBuilder builder;
  Material m = mirrorMaterial(0.5f);
  m.mirrorGrazing = Rgb(1.0f);
  m.mirrorMap = addHalves(builder);
  const Scene scene = squareOf(builder, m);

  expectColor(reflectedAt(scene, 0.25), RgbD(1.0));
  expectColor(reflectedAt(scene, 0.75), {0.25, 0, 1});

  const double schlick = reference::schlickTerm(std::cos(70 * kPi / 180));
  const auto at70 = [&](double normal) { return 2 * (normal + (1 - normal) * schlick); };
  expectColor(reflectedAt(scene, 0.75, 70), {at70(0.125), at70(0), at70(0.5)});

  // The map is not looked up without textures.
  expectColor(radianceBelow(scene, {0.75, 1, -0.5}, without(Effect::textures)), RgbD(1.0));
}

// A metal reflects with the colors of its vertices; another material does not.
TEST(VertexColors, TintTheMirrorsOfMetals) {
  for (const bool metal : {false, true}) {
    SceneBuilder builder;
    Material m = mirrorMaterial(0.5f);
    m.vertexTint = metal ? VertexTint::diffuseAndSpecular : VertexTint::diffuse;
    expectColor(reflectedAt(squareOf(builder, m, true), 0.5),
                metal ? RgbD{0.75, 1, 0.5} : RgbD(1.0));
  }
}

// A sheet transmits what the map and the colors of its vertices multiply.
TEST(TransmissionMaps, MultiplyTheRefractedRay) {
  for (const bool tinted : {false, true}) {
    SceneBuilder builder;
    Material m = blackMaterial();
    m.transmission = Rgb(0.5f);
    m.thin = true;
    m.transmissionMap = addHalves(builder);
    // The light that is transmitted is missing from the diffuse reflection.
    m.diffuse = Rgb(1.0f);
    m.diffuseReflection = false;
    const Scene scene = squareOf(builder, m, tinted);

    const RgbD color = tinted ? RgbD{0.625, 1, 0.25} : RgbD(1.0);
    expectColor(reflectedAt(scene, 0.75), RgbD{0.25, 0, 1} * color);
    expectColor(reflectedAt(scene, 0.25), tinted ? RgbD{0.875, 1, 0.75} : RgbD(1.0));
  }
}

TEST(TransmissionMaps, LeaveTheRestToTheDiffuseColor) {
  SceneBuilder builder;
  Material m = diffuseMaterial(1);
  m.transmission = Rgb(1.0f);
  m.thin = true;
  m.transmissionMap = addHalves(builder);
  lightEvenly(builder, 0.5f);
  const Scene scene = squareOf(builder, m);
  // Of the ambient light, and of the sky below, which is 2 as well.
  expectColor(reflectedAt(scene, 0.75), RgbD{0.75, 1, 0} * 0.5 + RgbD{0.25, 0, 1} * 2.0);
}

// The tiles are mirrors, sheets and glass with maps, with vertex colors and with neither.
Scene mappedTiles() {
  SceneBuilder builder;
  const std::int32_t map = addColors(builder);
  builder.sky(0.5f);
  return rowOfTiles(builder, [&](int i) {
    Material m = diffuseMaterial(0.5f);
    if (i != 2) m.mirror = Rgb(0.4f);
    m.mirrorGrazing = Rgb(1.0f);
    if (i < 2) m.mirrorMap = map;

    if (i % 2 == 0) m.vertexTint = VertexTint::diffuseAndSpecular;
    if (i > 1) {
      m.transmission = {0.5f, 0.25f, 0.5f};
      m.thin = i > 3;
      m.ior = i == 3 ? 1 : 1.5f;
    }
    if (i % 3 != 0) m.transmissionMap = map;
    Mesh mesh = tile(builder.add(m));
    if (i != 5) mesh.colors = {{1, 1, 1}, {0.5f, 1, 0}, {0, 0.3f, 1}, {1, 0, 1}};
    return mesh;
  });
}

TEST(ImpulseMaps, KeepTheLawsOfMaps) { expectTheLawsOfMaps(mappedTiles()); }

// Glass has mirrors as coats here, which do not reflect without the effect.
TEST(ImpulseMaps, AgreeWithTheReferenceWithoutMirrors) {
  expectTheReferenceWithout(mappedTiles(), {Effect::mirror});
}

TEST(ImpulseMaps, HaveStepsWhereTheSceneHasThem) {
  const Scene scene = mappedTiles();
  for (const char* step : {"lookUpMirror", "lookUpTransmission"}) {
    RenderOptions o = smallOptions();
    EXPECT_NE(makePlan(scene, o).find(step), nullptr);
    o.disable = {Effect::textures, Effect::vertexColors};
    EXPECT_EQ(makePlan(scene, o).find(step), nullptr);
  }
}

}  // namespace
}  // namespace whit::test
