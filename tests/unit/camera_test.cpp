#include "scene/camera.h"

#include <gtest/gtest.h>

#include <limits>
#include <tuple>

#include "pi.h"
#include "rounding.h"

namespace whit {
namespace {

constexpr double kFewRoundings = 8 * 0x1p-53;

Vec3d directionAt(const CameraFrame& f, double x, double y) {
  return normalized(f.forward + f.right * (x - f.width / 2.0) - f.up * (y - f.height / 2.0));
}

double angle(const Vec3d& a, const Vec3d& b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

// Expects a unit forward, with right and up of one length across it and each other; the picture
// needs all of this.
void expectSound(const CameraFrame& f) {
  ASSERT_TRUE(isFinite(f.eye) && isFinite(f.forward) && isFinite(f.right) && isFinite(f.up));
  EXPECT_NEAR(length(f.forward), 1, kFewRoundings);
  EXPECT_GT(length(f.right), 0);
  EXPECT_NEAR(length(f.up) / length(f.right), 1, kFewRoundings);
  EXPECT_NEAR(dot(normalized(f.right), f.forward), 0, kFewRoundings);
  EXPECT_NEAR(dot(normalized(f.right), normalized(f.up)), 0, kFewRoundings);
  EXPECT_GT(dot(cross(f.right, f.up), -f.forward), 0);  // right-handed, looking along -z
}

TEST(CameraFrame, VerticalFovFromTheNarrowestToTheWidest) {
  for (const float fov : {1e-3f, 0.1f, 45.0f, 179.9f}) {
    Camera camera;
    camera.fov = fov;

    const CameraFrame f = makeCameraFrame(camera, 64, 48);
    expectSound(f);
    const double seen = angle(directionAt(f, 32, 0), directionAt(f, 32, 48)) * 180 / kPi;
    // tan magnifies the rounding of its argument by 1 / cos^2, and its inverse reduces it again.
    // The float fov is exact.
    EXPECT_NEAR(seen, std::min(double{fov}, 179.9), 1e-12) << fov;
  }
}

// In a picture that is narrower than the camera's aspect, half of the width at distance 1 stays
// aspect * tan(fov / 2), and pixels are square. A wider picture keeps the height.
TEST(CameraFrame, NarrowPicturesKeepTheWidth) {
  Camera camera;
  camera.fov = 60;
  camera.aspect = 2;
  for (const auto& [width, height] : {std::pair{200, 200}, {100, 200}, {400, 200}, {500, 200}}) {
    const CameraFrame f = makeCameraFrame(camera, width, height);
    const double half = std::tan(30 * kPi / 180);
    const double pixel = width < 2 * height ? 2 * half * 2 / width : 2 * half / height;
    EXPECT_NEAR(length(f.right), pixel, 1e-7 * pixel) << width;
    EXPECT_EQ(length(f.up), length(f.right)) << width;
  }

  camera.orthographicHeight = 3;
  EXPECT_EQ(length(makeCameraFrame(camera, 100, 200).up), 3 * 2 / 100.0);
  EXPECT_EQ(length(makeCameraFrame(camera, 500, 200).up), 3 / 200.0);
}

TEST(CameraFrame, FovBeyondTheLimitsIsClamped) {
  const double narrowest = std::tan(0.5e-3 * kPi / 180), widest = std::tan(89.95 * kPi / 180);
  // The tangent of the widest angle multiplies the rounding of its argument.
  for (const auto& [fov, half, bound] : {std::tuple{0.0f, narrowest, kFewRoundings},
                                         {-20.0f, narrowest, kFewRoundings},
                                         {std::nanf(""), narrowest, kFewRoundings},
                                         {500.0f, widest, 1e-12}}) {
    Camera camera;
    camera.fov = fov;
    EXPECT_NEAR(length(makeCameraFrame(camera, 10, 10).up) / (2 * half / 10), 1, bound) << fov;
  }
}

// H75: directions do not depend on the camera's position.
TEST(CameraFrame, FarFromTheOriginNothingIsLost) {
  const Camera near{.eye = {0, 0, 0}, .at = {1, 2, -4}};
  Camera far;
  far.eye = Vec3f(8388608.0f);  // 2^23: floats are whole numbers here
  far.at = far.eye + near.at;

  const CameraFrame a = makeCameraFrame(near, 640, 480), b = makeCameraFrame(far, 640, 480);
  EXPECT_EQ(a.forward, b.forward);
  EXPECT_EQ(a.right, b.right);
  EXPECT_EQ(a.up, b.up);
  EXPECT_EQ(b.eye, Vec3d(far.eye));
}

TEST(CameraFrame, UpAlongTheViewPicksAnother) {
  for (const Vec3f& at : {Vec3f{0, -1, 0}, Vec3f{0, 1, 0}, Vec3f{0, -3, 1e-8f}}) {
    const CameraFrame f = makeCameraFrame({.eye = {0, 0, 0}, .at = at}, 30, 20);
    expectSound(f);
    expectNear(normalized(f.right), {1, 0, 0}, 1e-7);
  }

  const Camera sideways{.eye = {0, 0, 0}, .at = {0, 0, -1}, .up = {0, 0, -1}};
  expectNear(normalized(makeCameraFrame(sideways, 30, 20).up), {0, 1, 0}, kFewRoundings);
}

TEST(CameraFrame, SenselessCamerasStillGiveAPicture) {
  const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
  const Camera without{.eye = {1, 2, 3}, .at = {1, 2, 3}};
  expectNear(makeCameraFrame(without, 30, 20).forward, {0, 0, -1}, kFewRoundings);
  for (const Camera& camera : {without, Camera{.up = {0, 0, 0}},
                               Camera{.eye = {nan, 1, 2}, .at = {0, inf, 0}, .up = {nan, 0, 0}},
                               Camera{.eye = Vec3f(-3e38f), .at = Vec3f(3e38f)}}) {
    expectSound(makeCameraFrame(camera, 30, 20));
  }
}

TEST(CameraFrame, HasTheLensOfItsCamera) {
  Camera camera;
  camera.at = {0, 0, 2};
  EXPECT_EQ(makeCameraFrame(camera, 30, 20).reach, Vec3d());

  camera.aperture = 0.5f;
  const CameraFrame lens = makeCameraFrame(camera, 30, 20);
  EXPECT_EQ(lens.aperture, 0.5);
  EXPECT_EQ(lens.focus, 3);  // the target's distance
  EXPECT_EQ(lens.reach, Vec3d(0.5, 0.5, 0));

  camera.orthographicHeight = 4;
  expectNear(makeCameraFrame(camera, 30, 20).reach, {3.5, 2.5, 0}, kFewRoundings);
}

std::vector<Keyframe> pathOf(const std::vector<std::pair<float, float>>& timeAndX) {
  std::vector<Keyframe> path;
  for (const auto& [time, x] : timeAndX) {
    Keyframe k;
    k.time = time;
    k.camera.eye = {x, 0, 0};
    k.camera.at = {x, 0, -1};
    k.camera.fov = 10 * x;
    path.push_back(k);
  }
  return path;
}

TEST(CameraPath, PassesThroughItsKeyframesAndStopsAtItsEnds) {
  const auto path = pathOf({{1, 0}, {2, 5}, {4, 3}});
  const double nan = std::nan("");
  for (const auto& [time, x] : {std::pair{0.0, 0}, {1, 0}, {2, 5}, {4, 3}, {1e30, 3}, {nan, 0}}) {
    EXPECT_EQ(cameraAt(path, time).eye.x, x) << time;
  }
  EXPECT_EQ(cameraAt(pathOf({{3, 7}}), 5).eye.x, 7);
}

// Slopes at the keyframes (0, 0), (1, 1) and (2, 4) are 1 at the end and (4 - 0) / 2 = 2 in the
// middle. Halfway, a Hermite segment is (p0 + p1) / 2 + (m0 - m1) / 8 = 0.5 - 0.125.
TEST(CameraPath, CatmullRomHalfWay) {
  const Camera c = cameraAt(pathOf({{0, 0}, {1, 1}, {2, 4}}), 0.5);
  EXPECT_FLOAT_EQ(c.eye.x, 0.375f);
  EXPECT_FLOAT_EQ(c.at.x, 0.375f);
  EXPECT_FLOAT_EQ(c.fov, 5);  // linear
}

// Of two keyframes, one focuses on its target and the other states a distance.
TEST(CameraPath, FocusGoesFromTheTargetToADistance) {
  auto path = pathOf({{0, 0}, {1, 1}, {2, 2}});
  for (Keyframe& key : path) key.camera.aperture = 0.25f;
  path[1].camera.focus = 3;  // the targets are at distance 1

  EXPECT_EQ(cameraAt(path, 0).focusDistance(), 1);
  for (const auto& [time, focus] : {std::pair{0.5, 2.0f}, {1, 3}, {1.25, 2.5f}}) {
    EXPECT_FLOAT_EQ(cameraAt(path, time).focus, focus);
    EXPECT_FLOAT_EQ(cameraAt(path, time).aperture, 0.25f);
  }

  path[1].camera.focus = 0;
  EXPECT_EQ(cameraAt(path, 0.5).focus, 0);
}

TEST(CameraPath, UniformMotionStaysUniformForUnevenKeyframes) {
  const auto path = pathOf({{0, 0}, {1, 2}, {4, 8}, {4.5f, 9}});
  for (int i = 0; i <= 45; ++i) {
    EXPECT_NEAR(cameraAt(path, i / 10.0).eye.x, 2 * i / 10.0, 1e-6) << i;
  }
}

TEST(CameraPath, VelocityIsContinuous) {
  const auto path = pathOf({{0, 0}, {1, 3}, {3, -2}, {4, 4}});
  const double h = 1e-3;
  for (const double t : {1.0, 3.0}) {
    const double before = (cameraAt(path, t).eye.x - cameraAt(path, t - h).eye.x) / h;
    const double after = (cameraAt(path, t + h).eye.x - cameraAt(path, t).eye.x) / h;
    // First differences are off by h times the acceleration, which is below 40, and floats by 1e-6
    // / h.
    EXPECT_NEAR(before, after, 0.05);
  }
}

}  // namespace
}  // namespace whit
