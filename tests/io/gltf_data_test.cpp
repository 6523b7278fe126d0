// Real glTF files, where the data folder has them: they load, and the pipeline agrees with the
// reference.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "inspect/reference_frame.h"
#include "io/files.h"
#include "io/load_scene.h"
#include "render/renderer.h"

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
  for (std::size_t i = 0; i < a.display.rgba.size(); ++i) {
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

}  // namespace
}  // namespace whit
