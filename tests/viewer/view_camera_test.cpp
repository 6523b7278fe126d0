// Flying, looking and orbiting: where the camera must end, worked out by hand.
#include <gtest/gtest.h>

#include "pi.h"
#include "viewer/camera_control.h"

namespace whit::view {
namespace {

constexpr double kQuarterTurn = kPi / 2 / kRadiansPerPixel;  // pixels dragged
constexpr float kTolerance = 1e-5f;                          // a few roundings of floats of size 5

Camera facingOrigin() {
  Camera camera;
  camera.eye = {0, 0, 5};
  camera.at = {0, 0, 0};
  return camera;
}

void expectNear(const Vec3f& a, const Vec3f& b, float tolerance = kTolerance) {
  EXPECT_LE(maxComponent(abs(a - b)), tolerance)
      << a.x << ',' << a.y << ',' << a.z << " instead of " << b.x << ',' << b.y << ',' << b.z;
}

TEST(CameraControl, RestingKeepsEveryBit) {
  Camera camera;
  camera.eye = {0.1f, 0.2f, 0.3f};
  camera.at = {-7.7f, 1e-3f, 5e5f};
  camera.up = {0.1f, 1, 0.2f};
  CameraControl control(camera, 1);
  EXPECT_FALSE(control.step({}, 1));
  EXPECT_EQ(control.camera().eye, camera.eye);
  EXPECT_EQ(control.camera().at, camera.at);
  EXPECT_EQ(control.camera().up, camera.up);
}

TEST(CameraControl, FliesAlongItsOwnAxes) {
  const auto flown = [](CameraMotion motion) {
    CameraControl control(facingOrigin(), 2);
    EXPECT_TRUE(control.step(motion, 0.5));
    return control.camera();
  };
  CameraMotion motion;
  motion.forward = 1;
  expectNear(flown(motion).eye, {0, 0, 4});
  expectNear(flown(motion).at, {0, 0, -1});
  motion.fast = true;
  expectNear(flown(motion).eye, {0, 0, 5 - static_cast<float>(kFastFactor)});
  motion = {};
  motion.right = 1;
  expectNear(flown(motion).eye, {1, 0, 5});
  motion = {};
  motion.up = -1;
  expectNear(flown(motion).eye, {0, -1, 5});
}

TEST(CameraControl, DiagonalsAreNoFaster) {
  CameraControl control(facingOrigin(), 2);
  CameraMotion motion;
  motion.forward = motion.right = motion.up = 1;
  control.step(motion, 0.5);
  EXPECT_NEAR(length(control.camera().eye - facingOrigin().eye), 1, kTolerance);
}

TEST(CameraControl, UpIsTheCamerasOwn) {
  Camera camera = facingOrigin();
  camera.up = {3, 0, 0};
  CameraControl control(camera, 1);
  CameraMotion motion;
  motion.up = 1;
  control.step(motion, 1);
  expectNear(control.camera().eye, {1, 0, 5});
}

TEST(CameraControl, DraggingRightLooksRight) {
  CameraControl control(facingOrigin(), 1);
  CameraMotion motion;
  motion.lookX = kQuarterTurn;
  EXPECT_TRUE(control.step(motion, 0));
  expectNear(control.camera().eye, {0, 0, 5});
  expectNear(control.camera().at, {5, 0, 5});
}

TEST(CameraControl, ArrowsTurnWithTime) {
  CameraControl control(facingOrigin(), 1);
  CameraMotion motion;
  motion.turnRight = -1;
  control.step(motion, kPi / 2 / kRadiansPerSecond);
  expectNear(control.camera().at, {-5, 0, 5});
}

TEST(CameraControl, NeverTipsOver) {
  CameraControl control(facingOrigin(), 1);
  CameraMotion motion;
  motion.lookY = 10 * kQuarterTurn;  // far down
  control.step(motion, 0);
  const Vec3f view = control.camera().at - control.camera().eye;
  EXPECT_NEAR(view.y, -5 * std::sin(kSteepestRadians), kTolerance);
  EXPECT_LT(view.z, 0);  // still ahead, not behind
}

TEST(CameraControl, OrbitKeepsThePointLookedAt) {
  CameraControl control(facingOrigin(), 1);
  CameraMotion motion;
  motion.orbitX = kQuarterTurn;
  EXPECT_TRUE(control.step(motion, 0));
  expectNear(control.camera().eye, {-5, 0, 0});
  expectNear(control.camera().at, {0, 0, 0});
}

TEST(CameraControl, WheelChangesSpeedOnly) {
  CameraControl control(facingOrigin(), 3);
  CameraMotion motion;
  motion.wheel = 2;
  EXPECT_FALSE(control.step(motion, 1));
  EXPECT_DOUBLE_EQ(control.speed(), 3 * kWheelFactor * kWheelFactor);
}

TEST(CameraControl, StaysWhereScenesCanBe) {
  CameraControl control(facingOrigin(), 3);
  CameraMotion motion;
  motion.wheel = 1e4;
  control.step(motion, 0);
  EXPECT_DOUBLE_EQ(control.speed(), 3 * kSpeedRange);
  motion.wheel = 0;
  motion.right = 1;
  motion.fast = true;
  for (int i = 0; i < 100; ++i) control.step(motion, 1e15);
  EXPECT_TRUE(isFinite(control.camera().eye));
  EXPECT_TRUE(isFinite(control.camera().at));
  EXPECT_FALSE(control.step(motion, 1e15));
}

TEST(CameraControl, CreepsFarFromTheOrigin) {
  Camera camera = facingOrigin();
  camera.eye.x = camera.at.x = 1e6f;
  CameraControl control(camera, 0.01);  // 1/6000 a step, where floats are 1/16 apart
  CameraMotion motion;
  motion.right = 1;
  for (int i = 0; i < 6000; ++i) control.step(motion, 1.0 / 60);
  EXPECT_NEAR(control.camera().eye.x, 1e6 + 1, 1.0 / 16);
}

TEST(CameraControl, ViewAlongUpCanTurn) {
  Camera camera;
  camera.eye = {0, 5, 0};  // straight down, `up` no help
  CameraControl control(camera, 1);
  CameraMotion motion;
  motion.turnUp = 1;
  EXPECT_TRUE(control.step(motion, 0.1));
  EXPECT_TRUE(isFinite(control.camera().at));
  EXPECT_NEAR(length(control.camera().at - control.camera().eye), 5, kTolerance);
}

}  // namespace
}  // namespace whit::view
