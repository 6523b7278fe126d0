// Flying, looking and orbiting: where the camera must end, worked out by hand.
#include <gtest/gtest.h>

#include "engine/open_scene.h"
#include "pi.h"
#include "viewer/session/camera_control.h"

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
  motion.turnX = kQuarterTurn;
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
  motion.turnY = 10 * kQuarterTurn;  // far down
  control.step(motion, 0);

  // The view stays within the steepest angle to the horizon.
  const Vec3f view = control.camera().at - control.camera().eye;
  EXPECT_NEAR(view.y, -5 * std::sin(kSteepestRadians), kTolerance);
  EXPECT_LT(view.z, 0);  // still ahead, not behind
}

TEST(CameraControl, TheWheelWalksInARoom) {
  CameraControl control(facingOrigin(), 3);
  CameraMotion motion;
  motion.wheel = 2;
  EXPECT_TRUE(control.step(motion, 1));
  expectNear(control.camera().eye, {0, 0, static_cast<float>(5 - 3 * kNotchSeconds * 2)});
  motion.wheel = -2;
  control.step(motion, 1);
  expectNear(control.camera().eye, {0, 0, 5});
}

TEST(CameraControl, StaysWhereScenesCanBe) {
  CameraControl control(facingOrigin(), 3);
  CameraMotion motion;
  motion.right = 1;
  motion.fast = true;
  // The position of the camera has limits too.
  for (int i = 0; i < 1000; ++i) control.step(motion, 1e15);
  EXPECT_LE(maxComponent(abs(control.camera().eye)), kLargestCoordinate);
  EXPECT_LE(maxComponent(abs(control.camera().at)), kLargestCoordinate);
  EXPECT_FALSE(control.step(motion, 1e15));
}

TEST(CameraControl, CreepsFarFromTheOrigin) {
  Camera camera = facingOrigin();
  camera.eye.x = camera.at.x = 1e6f;
  CameraControl control(camera, 0.01);  // a step is 1/6000, where floats are 1/16 apart
  CameraMotion motion;
  motion.right = 1;
  for (int i = 0; i < 6000; ++i) control.step(motion, 1.0 / 60);
  EXPECT_NEAR(control.camera().eye.x, 1e6 + 1, 1.0 / 16);
}

TEST(CameraControl, ViewAlongUpCanTurn) {
  Camera camera;
  camera.eye = {0, 5, 0};  // straight down, where `up` is no help
  CameraControl control(camera, 1);
  CameraMotion motion;
  motion.turnUp = 1;
  EXPECT_TRUE(control.step(motion, 0.1));
  EXPECT_TRUE(isFinite(control.camera().at));
  EXPECT_NEAR(length(control.camera().at - control.camera().eye), 5, kTolerance);
}

// A model in a box of sides 2 about the origin.
CameraControl aroundModel(const Camera& camera = facingOrigin()) {
  CameraControl control(camera, 1);
  control.set(camera, Box{{-1, -1, -1}, {1, 1, 1}});
  return control;
}

TEST(CameraControl, OrbitKeepsThePointLookedAt) {
  CameraControl control = aroundModel();
  CameraMotion motion;
  motion.turnX = kQuarterTurn;
  EXPECT_TRUE(control.step(motion, 0));
  expectNear(control.camera().eye, {-5, 0, 0});
  expectNear(control.camera().at, {0, 0, 0});
}

TEST(CameraControl, TheWheelMovesCloserToAModel) {
  CameraControl control = aroundModel();
  CameraMotion motion;
  motion.wheel = 2;
  EXPECT_TRUE(control.step(motion, 0));
  expectNear(control.camera().eye, {0, 0, static_cast<float>(5 * kZoomFactor * kZoomFactor)});
  expectNear(control.camera().at, {0, 0, 0});

  // The wheel moves between the nearest and the farthest distance, in diagonals of the model.
  motion.wheel = 1e4;
  control.step(motion, 0);
  EXPECT_NEAR(control.camera().eye.z, kNearest * std::sqrt(12.0), kTolerance);

  motion.wheel = -1e5;
  control.step(motion, 0);
  EXPECT_NEAR(control.camera().eye.z, kFarthest * std::sqrt(12.0), 10 * kTolerance);
}

// A drag across the window's height moves the point that is orbited by the height that is seen at
// its distance.
TEST(CameraControl, PansWithThePointer) {
  CameraMotion motion;
  motion.panX = 0.1;
  motion.panY = 0.05;
  // The camera is 5 away and has half a field of view of 22.5 degrees.
  const float height = 2 * 5 * std::tan(22.5f * static_cast<float>(kPi) / 180);

  for (const bool model : {false, true}) {
    CameraControl control = model ? aroundModel() : CameraControl(facingOrigin(), 1);
    EXPECT_TRUE(control.step(motion, 0));
    expectNear(control.camera().eye, {-0.1f * height, 0.05f * height, 5});
    expectNear(control.camera().at, {-0.1f * height, 0.05f * height, 0});
  }
}

TEST(CameraControl, NoDragLosesAModel) {
  CameraControl control = aroundModel();
  CameraMotion motion;
  motion.panX = -50;
  motion.panY = 70;
  motion.turnX = 1234;
  motion.turnY = -777;
  motion.wheel = -3;

  for (int i = 0; i < 100; ++i) {
    control.step(motion, 0);
    EXPECT_LE(maxComponent(abs(control.camera().at)), 1 + kTolerance);
  }
}

// The point that is orbited lies at the depth of the model's middle, wherever `at` is.
TEST(CameraControl, OrbitsAModelWhoseCameraLooksAtAPointNearby) {
  Camera camera = facingOrigin();
  camera.at = {0, 0, 4.5f};
  CameraControl control = aroundModel(camera);
  EXPECT_EQ(control.camera().at, camera.at);
  CameraMotion motion;
  motion.turnX = kQuarterTurn;
  control.step(motion, 0);
  expectNear(control.camera().eye, {-5, 0, 0});
}

// The corner (1, 1, 1) lies at the border of the picture, so that its height is that of half the
// view.
TEST(CameraControl, FitsAModel) {
  for (const double aspect : {1.0, 2.0, 0.5}) {
    CameraControl control = aroundModel();
    CameraMotion motion;
    motion.wheel = -9;
    motion.panX = 0.3;
    control.step(motion, 0);
    control.fit(aspect);

    const double away = 1 + std::max(1.0, 1 / aspect) / std::tan(kPi / 8);
    expectNear(control.camera().eye, {0, 0, static_cast<float>(away)});
    expectNear(control.camera().at, {0, 0, 0});
  }
}

TEST(CameraControl, ParallelRaysComeCloserToo) {
  Camera camera = facingOrigin();
  camera.orthographicHeight = 4;
  CameraControl control = aroundModel(camera);
  CameraMotion motion;
  motion.wheel = 1;
  control.step(motion, 0);
  EXPECT_NEAR(control.camera().orthographicHeight, 4 * kZoomFactor, kTolerance);
  expectNear(control.camera().eye, {0, 0, 5});

  control.fit(2);
  EXPECT_NEAR(control.camera().orthographicHeight, 2, kTolerance);
}

TEST(CameraControl, WhatIsSeenFromOutsideIsOrbited) {
  const Box box{{-1, -1, -1}, {1, 1, 1}};
  Camera camera = facingOrigin();
  EXPECT_FALSE(boundsToOrbit(box, camera).empty());
  camera.eye = {0.5f, 0, 0};
  EXPECT_TRUE(boundsToOrbit(box, camera).empty());
  EXPECT_FALSE(CameraControl(facingOrigin(), 1).orbits());
}

// Shipped scenes are orbited where they are things on a floor, and looked around in where they are
// rooms or landscapes.
TEST(CameraControl, ShippedScenesAreOrbitedOrWalkedIn) {
  const auto orbited = [](const char* name) {
    const auto open = openScene({name, nullptr}, {}, false);
    return !boundsToOrbit(subjectOf(open->scene), open->scene.cameras.front()).empty();
  };
  for (const char* name : {"whitted", "glass", "orrery", "matte", "glossy", "effects", "cornell"}) {
    EXPECT_TRUE(orbited(name)) << name;
  }
  for (const char* name : {"atrium", "landscape"}) EXPECT_FALSE(orbited(name)) << name;
}

// The floor of orrery is 160 wide; what stands on it fits into 20.
TEST(CameraControl, TheFloorIsNotWhatIsLookedAt) {
  const auto open = openScene({"orrery", nullptr}, {}, false);
  const Box subject = subjectOf(open->scene);
  EXPECT_LT(maxComponent(subject.upper - subject.lower), 20);
}

}  // namespace
}  // namespace whit::view
