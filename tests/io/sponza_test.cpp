// A real model, Crytek Sponza, where the data folder has it.
#include <filesystem>

#include "bake/scene.h"
#include "io/files.h"
#include "scene_files.h"

namespace whit {
namespace {

TEST(Sponza, LoadsCompletely) {
  const std::filesystem::path model = dataFolder() / "crytek_sponza/sponza.obj";
  if (!std::filesystem::exists(model)) {
    GTEST_SKIP() << "NOT TESTED: " << model << " is not there; set WHIT_DATA";
  }

  Warnings warnings;
  const SceneDescription scene = loadScene(model.string(), {}, warnings);
  EXPECT_TRUE(warnings.entries().empty());
  EXPECT_EQ(triangleCount(scene), 262267u);  // as published with the model

  std::size_t cut = 0, bumpy = 0;
  for (const Material& material : scene.materials) {
    cut += material.alphaMap != kNoTexture;
    bumpy += material.normalMap != kNoTexture;
  }

  EXPECT_EQ(cut, 3u);  // leaf, plant, chain
  EXPECT_GT(bumpy, 10u);
  EXPECT_GT(scene.textures.size(), 30u);

  for (const Texture& texture : scene.textures) {
    EXPECT_LE(texture.width, 512) << texture.name;
    EXPECT_GE(texture.width, 64) << texture.name;
  }

  SceneDescription copy = scene;
  const Scene baked = Scene::finalize(std::move(copy), warnings);
  // The published box of the model, to the decimals that are stated.
  EXPECT_NEAR(baked.lower.x, -1920.9, 0.06);
  EXPECT_NEAR(baked.upper.y, 1429.4, 0.06);
}

TEST(Sponza, LoadsAlikeForAnyNumberOfThreads) {
  const std::filesystem::path model = dataFolder() / "crytek_sponza/sponza.obj";
  if (!std::filesystem::exists(model)) {
    GTEST_SKIP() << "NOT TESTED: " << model << " is not there; set WHIT_DATA";
  }

  Warnings warnings;
  LoadOptions one, four;
  one.threads = 1;
  four.threads = 4;
  const SceneDescription a = loadScene(model.string(), one, warnings);
  const SceneDescription b = loadScene(model.string(), four, warnings);

  ASSERT_EQ(a.textures.size(), b.textures.size());
  for (std::size_t i = 0; i < a.textures.size(); ++i) {
    EXPECT_EQ(a.textures[i].name, b.textures[i].name);
    EXPECT_EQ(a.textures[i].texels, b.textures[i].texels);
  }
}

}  // namespace
}  // namespace whit
