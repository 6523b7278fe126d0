// Rays from the eye against the geometry of the picture plane.
#include "reference/generate_rays.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "pi.h"
#include "reference/small_scenes.h"
#include "rounding.h"

namespace whit::reference {
namespace {

using namespace test;

TEST(GenerateRay, OfOrthographicCamerasStartsAsideOfTheEye) {
  const Camera camera{.eye = {1, 2, 3}, .at = {1, 2, -7}, .orthographicHeight = 4};
  const Ray ray = generateRay(makeCameraFrame(camera, 400, 200), 0, 0);
  expectNear(ray.origin, {-3, 4, 3}, 1e-15);
  EXPECT_EQ(ray.direction, Vec3d(0, 0, -1));
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

    const Ray central = generateRay(pinhole, 7.25, 13.5);
    for (const auto sample : indices(kSamples)) {
      const Ray ray = primaryRay(frame, 7, 13, {0.25f, 0.5f}, sample).ray;
      const Vec3d aside = ray.origin - central.origin;
      EXPECT_NEAR(dot(aside, frame.forward), 0, 1e-14);
      EXPECT_LE(length(aside), 0.5 + 1e-14);
      const auto atFocus = [&](const Ray& r) {
        return r.origin + r.direction * (6 / dot(r.direction, frame.forward));
      };
      expectNear(atFocus(ray), atFocus(central), 1e-13);
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

}  // namespace
}  // namespace whit::reference
