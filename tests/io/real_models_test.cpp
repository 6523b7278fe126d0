// Real models, where the data folder has them: they load completely and alike for any number of
// threads, and the pipeline agrees with the reference.
#include "inspect/reference_frame.h"
#include "io/files.h"
#include "render/renderer.h"
#include "scene_files.h"

namespace whit {
namespace {

struct File {
  const char* path;
  std::size_t triangles;  // as published with the models
};

class GltfData : public testing::TestWithParam<File> {};

TEST_P(GltfData, LoadsAndAgreesWithTheReference) {
  const std::filesystem::path path = dataFolder() / "gltf" / GetParam().path;
  if (!std::filesystem::exists(path)) {
    GTEST_SKIP() << "NOT TESTED: " << path << " is not there; set WHIT_DATA";
  }

  Warnings warnings;
  const Scene scene = Scene::finalize(loadScene(path.string(), {}, warnings), warnings);
  EXPECT_EQ(scene.instancedTriangles, GetParam().triangles);

  RenderOptions options;
  options.size = ImageSize{80, 50};
  Renderer renderer(scene, options);

  Film a = makeFilm(scene, options), b = makeFilm(scene, options);
  renderer.render(scene.cameras[0], a);
  renderReference(renderer, scene.cameras[0], b);

  std::size_t different = 0, lit = 0;
  for (const auto i : indices(a.display.rgba)) {
    different += std::abs(a.display.rgba[i] - b.display.rgba[i]) > 1;
    lit += i % 4 != 3 && a.display.rgba[i] > 20;
  }

  EXPECT_LE(different, a.display.rgba.size() / 1000);
  EXPECT_GT(lit, a.display.rgba.size() / 100);
}

INSTANTIATE_TEST_SUITE_P(Files, GltfData,
                         testing::Values(File{"FlightHelmet/FlightHelmet.gltf", 94722},
                                         File{"TransmissionRoughnessTest.glb", 77792},
                                         File{"glass-table.glb", 592},
                                         File{"blender_15_transmission/15_transmission.gltf", 4800},
                                         File{"blender_17_ior/17_ior.gltf", 60},
                                         File{"draco_pbr_next_sphere/sphere.gltf", 224}));

TEST(Sponza, LoadsCompletelyForAnyNumberOfThreads) {
  const std::filesystem::path model = dataFolder() / "crytek_sponza/sponza.obj";
  if (!std::filesystem::exists(model)) {
    GTEST_SKIP() << "NOT TESTED: " << model << " is not there; set WHIT_DATA";
  }

  Warnings warnings;
  LoadOptions options;
  options.threads = 4;
  const SceneDescription scene = loadScene(model.string(), options, warnings);
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

  const Scene baked = Scene::finalize(SceneDescription(scene), warnings);
  // The published box of the model, to the decimals that are stated.
  EXPECT_NEAR(baked.lower.x, -1920.9, 0.06);
  EXPECT_NEAR(baked.upper.y, 1429.4, 0.06);

  options.threads = 1;
  const SceneDescription alone = loadScene(model.string(), options, warnings);
  ASSERT_EQ(alone.textures.size(), scene.textures.size());
  for (const auto i : indices(alone.textures)) {
    EXPECT_EQ(alone.textures[i].name, scene.textures[i].name);
    EXPECT_EQ(alone.textures[i].texels, scene.textures[i].texels);
  }
}

}  // namespace
}  // namespace whit
