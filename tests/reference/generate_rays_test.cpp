// Rays from the eye against the geometry of the image plane.
#include "reference/generate_rays.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/pixel.h"
#include "reference/small_chunk.h"
#include "reference/small_scenes.h"
#include "sampling/random_streams.h"

namespace whit::reference {
namespace {

TEST(GenerateRay, PassesThroughTheImagePlane) {
  Camera camera;
  camera.eye = {1, 2, 3};
  camera.at = {1, 2, -7};
  camera.fov = 90;
  const CameraFrame frame = makeCameraFrame(camera, 400, 200);
  const auto towards = [&](double x, double y) { return generateRay(frame, x, y).direction; };
  EXPECT_EQ(generateRay(frame, 7, 8).origin, Vec3d(1, 2, 3));
  // 45 degrees up at the top of the middle column; x counts rightwards, y downwards.
  EXPECT_LT(length(towards(200, 0) - normalized(Vec3d{0, 1, -1})), 1e-15);
  EXPECT_LT(length(towards(0, 0) - normalized(Vec3d{-2, 1, -1})), 1e-15);
  EXPECT_LT(length(towards(400, 200) - normalized(Vec3d{2, -1, -1})), 1e-15);
  EXPECT_LT(length(towards(200, 100) - Vec3d{0, 0, -1}), 1e-15);
}

TEST(GenerateRay, OfOrthographicCamerasStartsAsideOfTheEye) {
  Camera camera;
  camera.eye = {1, 2, 3};
  camera.at = {1, 2, -7};
  camera.orthographicHeight = 4;
  const CameraFrame frame = makeCameraFrame(camera, 400, 200);
  EXPECT_LT(length(generateRay(frame, 0, 0).origin - Vec3d{-3, 4, 3}), 1e-15);
  EXPECT_EQ(generateRay(frame, 0, 0).direction, Vec3d(0, 0, -1));
}

TEST(GenerateRaysTwin, StartsAPathAPixel) {
  const Scene scene = test::SceneBuilder().build();
  test::SmallChunk small(scene);
  small.world.camera = makeCameraFrame(Camera(), 8, 8);
  small.world.camera.media = 5;
  const std::uint32_t pixels[] = {packedPixel(3, 4), packedPixel(5, 6)};
  small.chunk.pixels = pixels;
  small.chunk.sample = {0.25f, 0.75f};
  small.chunk.sampleNumber = 2;
  const RayRow row = generateRays(small.world, small.chunk, 1);
  const Ray ray = generateRay(small.world.camera, 5.25, 6.75);
  EXPECT_EQ(Vec3d(row.dirX, row.dirY, row.dirZ), ray.direction);
  EXPECT_EQ(row.weightG, 1);
  EXPECT_EQ(row.throughput, 1);
  EXPECT_EQ(row.parent, 1u);
  EXPECT_EQ(row.media, 5u);
  EXPECT_EQ(row.path, streamOfPixel(pixels[1], 2));
  EXPECT_EQ(row.cone, pixelCone(small.world.camera).width);
}

}  // namespace
}  // namespace whit::reference
