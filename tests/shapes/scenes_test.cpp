// The shipped scenes load, hold what they promise and need no repairs.
#include <gtest/gtest.h>

#include <filesystem>

#include "bake/scene.h"
#include "io/files.h"
#include "io/load_scene.h"
#include "source_files.h"

namespace whit::test {
namespace {

Scene load(const std::string& file, Warnings& warnings) {
  return Scene::finalize(loadScene(sourceFile("scenes/" + file), {}, warnings), warnings);
}

// Expects what all shipped scenes have. They need no repairs.
Scene shipped(const std::string& file) {
  Warnings strict(true);
  Scene scene = load(file, strict);
  EXPECT_TRUE(strict.entries().empty()) << file;
  EXPECT_GE(scene.cameras.size(), 3u) << file;
  EXPECT_GE(scene.cameraPath.size(), 2u) << file;
  EXPECT_FALSE(scene.lights.empty()) << file;
  EXPECT_FALSE(scene.triangles.empty()) << file;
  return scene;
}

TEST(Scenes, MirrorsAndWhittedAreWhatShippedScenesAre) {
  shipped("mirrors.json");
  shipped("whitted.json");
}

TEST(Scenes, AtriumIsLargeAndCallsForItsEffects) {
  const Scene scene = shipped("atrium.json");
  EXPECT_GE(scene.triangles.size(), 250000u);
  EXPECT_GE(scene.lights.size(), 2u);
  for (const Effect effect : {Effect::textures, Effect::normalMaps, Effect::alphaMasks,
                              Effect::mirror, Effect::sky, Effect::shadows}) {
    EXPECT_TRUE(scene.effects.has(effect)) << nameOf(effect);
  }
}

// Soft shadows and indirect light are effects that options switch on.
TEST(Scenes, MatteCallsForLightsAndShadowsOnly) {
  EXPECT_EQ(shipped("matte.json").effects.without(Effect::softShadows).without(Effect::indirect),
            EffectSet().with(Effect::lights).with(Effect::shadows));
}

TEST(Scenes, GlassNestsItsMedia) {
  const Scene scene = shipped("glass.json");
  EXPECT_TRUE(scene.effects.has(Effect::transmission));
  EXPECT_TRUE(scene.effects.has(Effect::absorption));
  EXPECT_GE(scene.media.size(), 5u);
}

TEST(Scenes, LandscapeHasAboutTheTrianglesAskedFor) {
  // Each of three forests rounds down by less than a tree of 4,000 triangles, and the ground by
  // less than a row.
  const Scene usual = shipped("landscape.json");
  EXPECT_NEAR(static_cast<double>(usual.instancedTriangles), 1e6, 2e4);

  const Scene small = shipped("landscape.json?triangles=300000");
  EXPECT_NEAR(static_cast<double>(small.instancedTriangles), 3e5, 2e4);
  EXPECT_TRUE(usual.effects.has(Effect::instances));
}

TEST(Scenes, SponzaHasAMirrorFloor) {
  if (!std::filesystem::exists(dataFolder() / "crytek_sponza/sponza.obj")) {
    GTEST_SKIP() << "NOT TESTED: no crytek_sponza in '" << dataFolder() << "'; set WHIT_DATA";
  }
  Warnings warnings;
  const Scene scene = load("sponza-mirror.json", warnings);
  EXPECT_GT(scene.triangles.size(), 250000u);
  EXPECT_TRUE(scene.effects.has(Effect::mirror));
  EXPECT_TRUE(scene.effects.has(Effect::skyImage));
}

}  // namespace
}  // namespace whit::test
