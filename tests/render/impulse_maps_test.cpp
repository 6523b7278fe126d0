// Mirrors and transmission by maps and vertex colors: the reference against closed forms, and the
// vector pipeline against the reference.
#include <gtest/gtest.h>

#include <functional>

#include "pi.h"
#include "reference/fresnel.h"
#include "render/plan.h"
#include "render/row_of_tiles.h"
#include "rounding.h"

namespace whit::test {
namespace {

// The square [0, 1]^2 of the floor has a map that is white to the left and (1/4, 0, 1) to the
// right. The sky above is 2, and it is dark below.
Scene halves(const std::function<void(Material&, std::int32_t)>& set, bool tinted = false) {
  SceneBuilder builder;
  const std::int32_t map = builder.add(makeTexture(
      TexelFormat::color, 2, 1, {encodeColorTexel({1, 1, 1}), encodeColorTexel({0.25f, 0, 1})}));

  Material m = blackMaterial();
  set(m, map);
  Mesh mesh = tile(builder.add(m));
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
  const Scene scene = halves([](Material& m, std::int32_t map) {
    m.mirror = Rgb(0.5f);
    m.mirrorGrazing = Rgb(1.0f);
    m.mirrorMap = map;
  });

  expectColor(reflectedAt(scene, 0.25), RgbD(1.0));
  expectColor(reflectedAt(scene, 0.75), {0.25, 0, 1});

  const double schlick = reference::schlickTerm(std::cos(70 * kPi / 180));
  const auto at70 = [&](double normal) { return 2 * (normal + (1 - normal) * schlick); };
  expectColor(reflectedAt(scene, 0.75, 70), {at70(0.125), at70(0), at70(0.5)});
}

TEST(MirrorMaps, AreNotLookedUpWithoutTextures) {
  const Scene scene = halves([](Material& m, std::int32_t map) {
    m.mirror = m.mirrorGrazing = Rgb(0.5f);
    m.mirrorMap = map;
  });

  reference::Settings settings = uncut();
  settings.effects = settings.effects.without(Effect::textures);
  expectColor(radianceAlong(scene, {0.75, 1, -0.5}, {0, -1, 0}, settings), RgbD(1.0));
}

// A metal reflects with the colors of its vertices; another material does not.
TEST(VertexColors, TintTheMirrorsOfMetals) {
  for (const VertexTint tint : {VertexTint::diffuse, VertexTint::diffuseAndSpecular}) {
    const Scene scene = halves(
        [&](Material& m, std::int32_t) {
          m.mirror = Rgb(0.5f);
          m.mirrorGrazing = Rgb(1.0f);
          m.vertexTint = tint;
        },
        true);

    const bool metal = tint == VertexTint::diffuseAndSpecular;
    expectColor(reflectedAt(scene, 0.5), metal ? RgbD{0.75, 1, 0.5} : RgbD(1.0));
  }
}

// A sheet transmits what the map and the colors of its vertices multiply.
TEST(TransmissionMaps, MultiplyTheRefractedRay) {
  for (const bool tinted : {false, true}) {
    const Scene scene = halves(
        [](Material& m, std::int32_t map) {
          m.transmission = Rgb(0.5f);
          m.thin = true;
          m.transmissionMap = map;
          // The light that is transmitted is missing from the diffuse reflection.
          m.diffuse = Rgb(1.0f);
          m.diffuseReflection = false;
        },
        tinted);

    const RgbD color = tinted ? RgbD{0.625, 1, 0.25} : RgbD(1.0);
    expectColor(reflectedAt(scene, 0.75), RgbD{0.25, 0, 1} * color);
    expectColor(reflectedAt(scene, 0.25), tinted ? RgbD{0.875, 1, 0.75} : RgbD(1.0));
  }
}

TEST(TransmissionMaps, LeaveTheRestToTheDiffuseColor) {
  const Scene scene = [] {
    SceneBuilder builder;
    Material m = diffuseMaterial(1);
    m.transmission = Rgb(1.0f);
    m.thin = true;
    m.transmissionMap =
        builder.add(makeTexture(TexelFormat::color, 1, 1, {encodeColorTexel(Rgb(0.25f))}));

    builder.add(floorAt(0, 10, builder.add(m)));
    builder.description.ambient = {Rgb(1.0f), Rgb(1.0f)};
    return builder.build();
  }();
  expectColor(radianceAlong(scene, {0.3, 1, 0.2}, {0, -1, 0}), RgbD(0.75));
}

// The tiles are mirrors, sheets and glass with maps, with vertex colors and with neither.
Scene mappedTiles() {
  SceneBuilder builder;
  const std::int32_t map = builder.add(makeTexture(
      TexelFormat::color, 2, 2, {1023u, 700u << 10 | 300u, 341u | 341u << 10 | 341u << 20, 900u}));

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
    }
    if (i % 3 != 0) m.transmissionMap = map;
    Mesh mesh = tile(builder.add(m));
    if (i != 5) mesh.colors = {{1, 1, 1}, {0.5f, 1, 0}, {0, 0.3f, 1}, {1, 0, 1}};
    return mesh;
  });
}

TEST(ImpulseMaps, KeepTheLawsOfMaps) { expectTheLawsOfMaps(mappedTiles()); }

TEST(ImpulseMaps, HaveStepsWhereTheSceneHasThem) {
  Scene scene = mappedTiles();
  for (const char* step : {"lookUpMirror", "lookUpTransmission"}) {
    EXPECT_NE(makePlan(scene, smallOptions()).find(step), nullptr);
    RenderOptions o = smallOptions();
    o.disable = EffectSet().with(Effect::textures).with(Effect::vertexColors);
    EXPECT_EQ(makePlan(scene, o).find(step), nullptr);
  }
}

}  // namespace
}  // namespace whit::test
