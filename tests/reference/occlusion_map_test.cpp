// Occlusion maps: they scale indirect light, and no other light.
#include <gtest/gtest.h>

#include <functional>

#include "reference/small_scenes.h"
#include "rounding.h"

namespace whit::reference {
namespace {

constexpr double kShare = 0.2;  // 51 / 255

// Returns the square [0, 1]^2 of the floor y = 0, whose map has 1 on the left and 0.2 on the right
// along x.
Scene mappedFloor(const Material& of, const std::function<void(SceneDescription&)>& lit,
                  bool bySecondUvs = false) {
  test::SceneBuilder builder;
  Material m = of;
  m.occlusionMap = builder.add(test::makeTexture(
      TexelFormat::data, 2, 1,
      {encodeDataTexel(1, 0, 0, 1), encodeDataTexel(static_cast<float>(kShare), 1, 1, 1)}));
  m.occlusionBySecondUvs = bySecondUvs;

  Mesh mesh = test::quad({0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}, builder.add(m));
  mesh.secondUvs = {{1, 0}, {0, 0}, {0, 1}, {1, 1}};  // u runs along -x
  builder.add(mesh);

  lit(builder.description);
  return builder.build();
}

double pictureAt(const Scene& scene, double x, const Settings& settings = test::uncut()) {
  return test::radianceAlong(scene, {x, 1, -0.5}, {0, -1, 0}, settings).x;
}

void lightSky(SceneDescription& d) {
  d.sky.kind = Sky::Kind::color;
  d.sky.zenith = Rgb(2.0f);
}

Material glossy() {
  Material m = test::blackMaterial();
  m.specular = Rgb(0.5f);
  m.roughness = 0.6f;
  return m;
}

TEST(OcclusionMaps, DimAmbientLight) {
  const Scene scene = mappedFloor(test::diffuseMaterial(0.5f), [](SceneDescription& d) {
    d.ambient = {Rgb(1.0f), Rgb(1.0f)};
  });
  EXPECT_NEAR(pictureAt(scene, 0.25), 0.5, kRounding);
  EXPECT_NEAR(pictureAt(scene, 0.5), 0.5 * 0.6, kRounding) << "halfway between the texels";
  EXPECT_NEAR(pictureAt(scene, 0.75), 0.5 * kShare, kRounding);
}

TEST(OcclusionMaps, DimTheBlurredSky) {
  const Scene scene = mappedFloor(glossy(), lightSky);
  const double open = pictureAt(scene, 0.25);
  EXPECT_GT(open, 0.5);
  EXPECT_NEAR(pictureAt(scene, 0.75), kShare * open, kRounding * open);
}

// Under an even sky each ray of a lobe that does not end in the floor brings the same light.
TEST(OcclusionMaps, DimTheSamplesOfLobes) {
  const Scene rough = mappedFloor(glossy(), lightSky);
  const Scene matt = mappedFloor(test::diffuseMaterial(0.5f), lightSky);
  Settings settings = test::uncut();
  settings.options.glossy = settings.options.indirect = 16;

  const double open = pictureAt(rough, 0.25, settings);
  EXPECT_GT(open, 0.5);
  EXPECT_NEAR(pictureAt(rough, 0.75, settings), kShare * open, kRounding * open);

  EXPECT_NEAR(pictureAt(matt, 0.25, settings), 1, kRounding);
  EXPECT_NEAR(pictureAt(matt, 0.75, settings), kShare, kRounding);
}

TEST(OcclusionMaps, LeaveLightsEmissionAndMirrorsAlone) {
  Material m = test::diffuseMaterial(0.5f);
  m.specular = Rgb(0.1f);
  m.glossyReflection = false;
  m.mirror = m.mirrorGrazing = Rgb(0.25f);
  m.emission = Rgb(3.0f);

  const Scene scene = mappedFloor(m, [](SceneDescription& d) {
    d.lights = {test::sun({0, -1, 0}, 2)};
    lightSky(d);
  });
  EXPECT_NEAR(pictureAt(scene, 0.75), pictureAt(scene, 0.25), kRounding * pictureAt(scene, 0.25));
}

TEST(OcclusionMaps, AreLookedUpWithTheirOwnCoordinates) {
  const Scene scene = mappedFloor(
      test::diffuseMaterial(0.5f),
      [](SceneDescription& d) {
        d.ambient = {Rgb(1.0f), Rgb(1.0f)};
      },
      true);
  EXPECT_NEAR(pictureAt(scene, 0.25), 0.5 * kShare, kRounding);
  EXPECT_NEAR(pictureAt(scene, 0.75), 0.5, kRounding);
}

}  // namespace
}  // namespace whit::reference
