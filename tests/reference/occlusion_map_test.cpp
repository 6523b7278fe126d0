// Occlusion maps: they scale indirect light, and no other light.
#include <gtest/gtest.h>

#include "reference/small_scenes.h"
#include "rounding.h"

namespace whit::reference {
namespace {

using namespace test;

constexpr double kShare = 0.2;  // 51 / 255

// Returns the square [0, 1]^2 of the floor y = 0, whose map has 1 on the left and 0.2 on the right
// along x.
Scene mappedFloor(Material m, void (*lit)(SceneBuilder&)) {
  SceneBuilder builder;
  m.occlusionMap = builder.add(makeTexture(
      TexelFormat::data, 2, 1,
      {encodeDataTexel(1, 0, 0, 1), encodeDataTexel(static_cast<float>(kShare), 1, 1, 1)}));
  Mesh mesh = quad({0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}, builder.add(m));
  mesh.secondUvs = {{1, 0}, {0, 0}, {0, 1}, {1, 1}};  // u runs along -x
  builder.add(mesh);

  lit(builder);
  return builder.build();
}

double pictureAt(const Scene& scene, double x, const Settings& settings = uncut()) {
  return radianceBelow(scene, {x, 1, -0.5}, settings).x;
}

void lightSky(SceneBuilder& builder) { builder.sky(2); }

void lightEverywhere(SceneBuilder& builder) { lightEvenly(builder, 1); }

TEST(OcclusionMaps, DimAmbientLight) {
  const Scene scene = mappedFloor(diffuseMaterial(0.5f), lightEverywhere);
  EXPECT_NEAR(pictureAt(scene, 0.25), 0.5, kRounding);
  EXPECT_NEAR(pictureAt(scene, 0.5), 0.5 * 0.6, kRounding) << "halfway between the texels";
  EXPECT_NEAR(pictureAt(scene, 0.75), 0.5 * kShare, kRounding);
}

// Under an even sky each ray of a lobe that does not end in the floor brings the same light.
// Without rays the glossy lobe reflects the blurred sky.
TEST(OcclusionMaps, DimTheBlurredSkyAndTheSamplesOfLobes) {
  const Scene rough = mappedFloor(glossyMaterial(0, 0.5f, 0.6f), lightSky);
  for (const Settings& settings : {sampled(0), sampled(16)}) {
    const double open = pictureAt(rough, 0.25, settings);
    EXPECT_GT(open, 0.5);
    EXPECT_NEAR(pictureAt(rough, 0.75, settings), kShare * open, kRounding * open);
  }

  const Scene matt = mappedFloor(diffuseMaterial(0.5f), lightSky);
  Settings settings = uncut();
  settings.options.indirect = 16;
  EXPECT_NEAR(pictureAt(matt, 0.25, settings), 1, kRounding);
  EXPECT_NEAR(pictureAt(matt, 0.75, settings), kShare, kRounding);
}

TEST(OcclusionMaps, LeaveLightsEmissionAndMirrorsAlone) {
  Material m = diffuseMaterial(0.5f);
  m.specular = Rgb(0.1f);
  m.glossyReflection = false;
  m.mirror = m.mirrorGrazing = Rgb(0.25f);
  m.emission = Rgb(3.0f);

  const Scene scene = mappedFloor(m, [](SceneBuilder& builder) {
    builder.description.lights = {sun({0, -1, 0}, 2)};
    lightSky(builder);
  });
  const double open = pictureAt(scene, 0.25);
  EXPECT_NEAR(pictureAt(scene, 0.75), open, kRounding * open);
}

TEST(OcclusionMaps, AreLookedUpWithTheirOwnCoordinates) {
  Material m = diffuseMaterial(0.5f);
  m.occlusionBySecondUvs = true;
  const Scene scene = mappedFloor(m, lightEverywhere);
  EXPECT_NEAR(pictureAt(scene, 0.25), 0.5 * kShare, kRounding);
  EXPECT_NEAR(pictureAt(scene, 0.75), 0.5, kRounding);
}

}  // namespace
}  // namespace whit::reference
