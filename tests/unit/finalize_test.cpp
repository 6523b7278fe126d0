// Media, cameras and sizes of a finalized scene.
#include <gtest/gtest.h>

#include <cmath>

#include "farthest_in_picture.h"
#include "unit/scene_builder.h"

namespace whit {
namespace {

using namespace test;

TEST(Finalize, EmptySceneHasAWorldAndACamera) {
  const Scene scene = finalized(SceneDescription());
  ASSERT_EQ(scene.geometries.size(), 1u);
  EXPECT_TRUE(scene.geometries[0].index.empty());
  EXPECT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.lower, Vec3f{});
  EXPECT_EQ(scene.upper, Vec3f{});
  EXPECT_EQ(scene.media.size(), 1u);
}

TEST(Finalize, MediaAreNumberedOncePerDielectricInUse) {
  SceneDescription d = sceneOf(square());
  d.materials.resize(6);
  for (std::size_t i = 1; i < 6; ++i) d.materials[i].transmission = Rgb(1.0f);
  d.materials[2].ior = 1.33f;
  d.materials[3].name = "glass again";
  d.materials[4].priority = 2;
  d.materials[5].ior = 2;  // in no mesh

  Mesh& mesh = d.objects[0].meshes[0];
  mesh.triangles.assign(5, {0, 1, 2});
  mesh.materials = {0, 1, 2, 3, 4};

  const Scene scene = finalized(d);
  EXPECT_EQ(scene.mediumOfMaterial, (std::vector<std::uint8_t>{0, 1, 2, 1, 3, 0}));
  ASSERT_EQ(scene.media.size(), 4u);
  EXPECT_EQ(scene.media[0].ior, 1);
  EXPECT_EQ(scene.media[1].ior, 1.5f);
  EXPECT_EQ(scene.media[2].ior, 1.33f);
  EXPECT_EQ(scene.media[3].priority, 2);
}

TEST(Finalize, At255MediaTheNumbersEnd) {
  const auto withMedia = [](std::uint32_t count) {
    SceneDescription d = sceneOf(square());
    d.materials.resize(count);

    Mesh& mesh = d.objects[0].meshes[0];
    mesh.triangles.assign(count, {0, 1, 2});
    mesh.materials.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
      d.materials[i].transmission = Rgb(1.0f);
      d.materials[i].priority = static_cast<int>(i);
      mesh.materials.push_back(i);
    }
    return d;
  };

  EXPECT_EQ(finalized(withMedia(255)).mediumOfMaterial.back(), 255);
  expectError(ExitStatus::limit, {"255"}, [&] { finalized(withMedia(256)); });
}

TEST(Finalize, SuppliedCameraSeesAllOfTheScene) {
  for (const auto& [width, height] : {std::pair{480, 300}, {100, 400}}) {
    SceneDescription d =
        placedAs(square(), Affine::translation({500, -20, 3}) * Affine::scaling({40, 2, 9}));
    d.width = width;
    d.height = height;

    const Scene scene = finalized(d);
    ASSERT_EQ(scene.cameras.size(), 1u);
    std::vector<Vec3d> corners;
    for (int i = 0; i < 8; ++i) {
      corners.push_back(Vec3d(Box{scene.lower, scene.upper}.corner(i)));
    }
    EXPECT_LE(farthestInPicture(makeCameraFrame(scene.cameras[0], width, height), corners), 1);
  }
}

TEST(Finalize, CamerasOfTheSceneComeFirst) {
  SceneDescription d = sceneOf(square());
  d.cameraPath.resize(1);
  d.cameraPath[0].camera.eye = {7, 7, 7};
  EXPECT_EQ(finalized(d).cameras[0].eye, (Vec3f{7, 7, 7}));

  d.cameras.resize(1);
  d.cameras[0].eye = {1, 2, 3};
  const Scene scene = finalized(d);
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.cameras[0].eye, (Vec3f{1, 2, 3}));
}

TEST(Finalize, MemoryIsCounted) {
  SceneDescription d = sceneOf(square());
  d.textures.push_back(whiteTexture(TexelFormat::data));
  EXPECT_EQ(finalized(d).memoryBytes(), 2 * 64 + 2 * 12 + 4 * 12 + 4 + 12u);
}

}  // namespace
}  // namespace whit
