#include "scene/camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pi.h"
#include "rounding.h"

namespace whit {
namespace {

constexpr double kFewRoundings = 8 * 0x1p-53;

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

TEST(CameraFrame, VerticalFovStaysWithinItsLimits) {
  // Pairs of the fov that is asked for and the one that is seen.
  for (const auto& [fov, seen] : {std::pair{0.0f, 1e-3},
                                  {-20.0f, 1e-3},
                                  {NAN, 1e-3},
                                  {1e-3f, double{1e-3f}},
                                  {0.1f, double{0.1f}},
                                  {45.0f, 45.0},
                                  {179.9f, double{179.9f}},
                                  {500.0f, 179.9}}) {
    Camera camera;
    camera.fov = fov;

    const CameraFrame f = makeCameraFrame(camera, 64, 48);
    expectSound(f);
    // The tangent of the widest angle multiplies the rounding of its argument.
    const double height = 2 * std::tan(seen * kPi / 360);
    EXPECT_NEAR(length(f.up) * 48 / height, 1, seen < 90 ? kFewRoundings : 1e-12) << fov;
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
  const Camera without{.eye = {1, 2, 3}, .at = {1, 2, 3}};
  expectNear(makeCameraFrame(without, 30, 20).forward, {0, 0, -1}, kFewRoundings);
  for (const Camera& camera :
       {without, Camera{.up = {0, 0, 0}},
        Camera{.eye = {NAN, 1, 2}, .at = {0, INFINITY, 0}, .up = {NAN, 0, 0}},
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
  for (const auto& [time, x] : {std::pair{0.0, 0}, {1, 0}, {2, 5}, {4, 3}, {1e30, 3}, {NAN, 0}}) {
    EXPECT_EQ(cameraAt(path, time).eye.x, x) << time;
  }
  EXPECT_EQ(cameraAt(pathOf({{3, 7}}), 5).eye.x, 7);
}

// The speed at a keyframe is the slope between its neighbors, or towards the only one: 3, -2/3, 1/3
// and 6 here. Between keyframes there are Hermite's polynomials, whose duration may be uneven.
TEST(CameraPath, IsACatmullRomSpline) {
  const auto path = pathOf({{0, 0}, {1, 3}, {3, -2}, {4, 4}});
  for (const auto& [time, x] : {std::pair{0.25, 0.921875f},
                                {0.5, 1.5f + 11 / 24.0f},
                                {1.5, 2.0f},
                                {2.5, -1.375f},
                                {3.5, 1 - 17 / 24.0f},
                                {3.75, 2.234375f}}) {
    const Camera camera = cameraAt(path, time);
    EXPECT_FLOAT_EQ(camera.eye.x, x) << time;
    EXPECT_FLOAT_EQ(camera.at.x, x) << time;
  }
  EXPECT_FLOAT_EQ(cameraAt(path, 0.5).fov, 15);  // linear
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

}  // namespace
}  // namespace whit
