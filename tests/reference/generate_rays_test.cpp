// Rays from the eye against the geometry of the picture plane.
#include "reference/generate_rays.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/image.h"
#include "pi.h"
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

  // The top of the middle column is 45 degrees up. x grows to the right and y downwards.
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

// The rays of a sample cross the central ray of the lens in the plane of focus. Their origins are
// spread evenly over the disk.
TEST(PrimaryRay, PassesTheLensAndMeetsThePlaneOfFocus) {
  for (const float height : {0.0f, 4.0f}) {
    Camera camera;
    camera.eye = {1, 2, 3};
    camera.at = {4, 0, -7};
    camera.orthographicHeight = height;
    const CameraFrame pinhole = makeCameraFrame(camera, 40, 20);
    camera.aperture = 0.5f;
    camera.focus = 6;
    const CameraFrame frame = makeCameraFrame(camera, 40, 20);

    constexpr int kSamples = 256;
    Vec3d mean;
    double squares = 0;
    std::array<int, 8> sectors{};

    for (std::size_t sample = 0; sample < kSamples; ++sample) {
      const Ray central = generateRay(pinhole, 7.25, 13.5);
      const Ray ray = primaryRay(frame, 7, 13, {0.25f, 0.5f}, sample).ray;
      EXPECT_EQ(primaryRay(pinhole, 7, 13, {0.25f, 0.5f}, sample).ray.origin, central.origin);
      EXPECT_EQ(primaryRay(pinhole, 7, 13, {0.25f, 0.5f}, sample).ray.direction, central.direction);

      const Vec3d aside = ray.origin - central.origin;
      EXPECT_NEAR(dot(aside, frame.forward), 0, 1e-14);
      EXPECT_LE(length(aside), 0.5 + 1e-14);
      const auto atFocus = [&](const Ray& r) {
        return r.origin + r.direction * (6 / dot(r.direction, frame.forward));
      };
      EXPECT_LT(length(atFocus(ray) - atFocus(central)), 1e-13);
      EXPECT_NEAR(length(ray.direction), 1, 1e-15);

      mean += aside * (1.0 / kSamples);
      squares += dot(aside, aside) / kSamples;
      const double turn = std::atan2(dot(aside, frame.up), dot(aside, frame.right));
      ++sectors[static_cast<std::size_t>((turn / kPi + 1) * 4) % 8];
    }

    EXPECT_LT(length(mean), 0.01);
    EXPECT_NEAR(squares, 0.125, 0.002);  // half the radius squared
    for (const int count : sectors) EXPECT_NEAR(count, kSamples / 8, 4);
  }
}

TEST(GenerateRaysReference, TakesTheLensOfItsSample) {
  const Scene scene = test::SceneBuilder().build();
  test::SmallChunk small(scene);
  Camera camera;
  camera.aperture = 1;
  small.world.camera = makeCameraFrame(camera, 8, 8);

  const std::uint32_t pixels[] = {packedPixel(3, 4)};
  small.chunk.pixels = pixels;
  small.chunk.sample = {0.25f, 0.75f};
  small.chunk.sampleNumber = 2;

  const RayRow row = generateRays(small.world, small.chunk, 0);
  const Ray ray = primaryRay(small.world.camera, 3, 4, {0.25f, 0.75f}, 2).ray;
  EXPECT_EQ(Vec3d(row.org), ray.origin);
  EXPECT_EQ(Vec3d(row.dir), ray.direction);
  EXPECT_NE(ray.origin, Vec3d(camera.eye));
}

TEST(GenerateRaysReference, StartsAPathAPixel) {
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
  EXPECT_EQ(Vec3d(row.dir), ray.direction);

  EXPECT_EQ(row.weight.y, 1);
  EXPECT_EQ(row.throughput, 1);
  EXPECT_EQ(row.parent, 1u);
  EXPECT_EQ(row.media, 5u);
  EXPECT_EQ(row.path, streamOfPixel(pixels[1], 2));
  EXPECT_EQ(row.cone, pixelCone(small.world.camera).width);
}

}  // namespace
}  // namespace whit::reference
