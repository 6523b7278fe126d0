// Flying, looking and orbiting: where the camera must end, worked out by hand. A camera begins at
// (0, 0, 5) and faces the origin unless a test moves it.
#include <gtest/gtest.h>

#include "engine/open_scene.h"
#include "pi.h"
#include "rounding.h"
#include "viewer/session/camera_control.h"

namespace whit::view {
namespace {

constexpr double kQuarterTurn = kPi / 2 / kRadiansPerPixel;  // pixels dragged
constexpr double kTolerance = 1e-5f;                         // a few roundings of floats of size 5

void expectNear(const Vec3f& got, const Vec3d& wanted) {
  whit::expectNear(Vec3d(got), wanted, kTolerance);
}

// A model in a box of sides 2 about the origin.
const Box kModel{{-1, -1, -1}, {1, 1, 1}};

CameraControl aroundModel(const Camera& camera = {}) {
  CameraControl control(camera, 1);
  control.set(camera, kModel);
  return control;
}

TEST(CameraControl, RestingKeepsEveryBit) {
  Camera camera;
  camera.eye = {0.1f, 0.2f, 0.3f};
  camera.at = {-7.7f, 1e-3f, 5e5f};
  camera.up = {0.1f, 1, 0.2f};
  CameraControl control(camera, 1);
  EXPECT_FALSE(control.step({}, 1));
  EXPECT_TRUE(sameView(control.camera(), camera));
}

// Returns where a control that moves ends.
Camera moved(CameraControl control, const CameraMotion& motion, double seconds = 0) {
  EXPECT_TRUE(control.step(motion, seconds));
  return control.camera();
}

struct Motion {
  const char* name;
  CameraMotion motion;
  double seconds;
  Vec3d eye, at;  // where the camera ends
};

// A room's camera moves by one unit where it walks for half a second.
constexpr double kWalk = 0.5;
const Motion kInRooms[] = {
    {"forward", {.forward = 1}, kWalk, {0, 0, 4}, {0, 0, -1}},
    {"fast", {.forward = 1, .fast = true}, kWalk, {0, 0, 5 - kFastFactor}, {0, 0, -kFastFactor}},
    {"right", {.right = 1}, kWalk, {1, 0, 5}, {1, 0, 0}},
    {"down", {.up = -1}, kWalk, {0, -1, 5}, {0, -1, 0}},
    {"dragged to the right", {.turnX = kQuarterTurn}, 0, {0, 0, 5}, {5, 0, 5}},
    {"arrow to the left", {.turnRight = -1}, kPi / 2 / kRadiansPerSecond, {0, 0, 5}, {-5, 0, 5}},
    {"wheel", {.wheel = 2}, 0, {0, 0, 5 - 2 * kNotchSeconds * 2}, {0, 0, -2 * kNotchSeconds * 2}},
};
const Motion kAboutModels[] = {
    {"orbit", {.turnX = kQuarterTurn}, 0, {-5, 0, 0}, {0, 0, 0}},
    {"wheel", {.wheel = 2}, 0, {0, 0, 5 * kZoomFactor* kZoomFactor}, {0, 0, 0}},
};

void expectMoved(const CameraControl& control, const Motion& by) {
  SCOPED_TRACE(by.name);
  const Camera camera = moved(control, by.motion, by.seconds);
  expectNear(camera.eye, by.eye);
  expectNear(camera.at, by.at);
}

TEST(CameraControl, MovesAndTurnsInRoomsAndAboutModels) {
  for (const Motion& motion : kInRooms) expectMoved(CameraControl(Camera(), 2), motion);
  for (const Motion& motion : kAboutModels) expectMoved(aroundModel(), motion);
}

TEST(CameraControl, DiagonalsAreNoFaster) {
  const CameraMotion diagonal{.forward = 1, .right = 1, .up = 1};
  const Vec3f eye = moved(CameraControl(Camera(), 2), diagonal, kWalk).eye;
  EXPECT_NEAR(length(eye - Camera().eye), 1, kTolerance);
}

TEST(CameraControl, UpIsTheCamerasOwn) {
  Camera camera;
  camera.up = {3, 0, 0};
  expectNear(moved(CameraControl(camera, 1), {.up = 1}, 1).eye, {1, 0, 5});
}

TEST(CameraControl, NeverTipsOver) {
  const Camera down = moved(CameraControl(Camera(), 1), {.turnY = 10 * kQuarterTurn});

  // The view stays within the steepest angle to the horizon.
  const Vec3f view = down.at - down.eye;
  EXPECT_NEAR(view.y, -5 * std::sin(kSteepestRadians), kTolerance);
  EXPECT_LT(view.z, 0);  // still ahead, not behind
}

TEST(CameraControl, StaysWhereScenesCanBe) {
  CameraControl control(Camera(), 3);
  const CameraMotion motion{.right = 1, .fast = true};
  // The position of the camera has limits too.
  for (int i = 0; i < 1000; ++i) control.step(motion, 1e15);
  EXPECT_LE(maxComponent(abs(control.camera().eye)), kLargestCoordinate);
  EXPECT_LE(maxComponent(abs(control.camera().at)), kLargestCoordinate);
  EXPECT_FALSE(control.step(motion, 1e15));
}

TEST(CameraControl, CreepsFarFromTheOrigin) {
  Camera camera;
  camera.eye.x = camera.at.x = 1e6f;
  CameraControl control(camera, 0.01);  // a step is 1/6000, where floats are 1/16 apart
  for (int i = 0; i < 6000; ++i) control.step({.right = 1}, 1.0 / 60);
  EXPECT_NEAR(control.camera().eye.x, 1e6 + 1, 1.0 / 16);
}

TEST(CameraControl, ViewAlongUpCanTurn) {
  Camera camera;
  camera.eye = {0, 5, 0};  // straight down, where `up` is no help
  const Vec3f at = moved(CameraControl(camera, 1), {.turnUp = 1}, 0.1).at;
  EXPECT_NEAR(length(at - camera.eye), 5, kTolerance);
}

// The wheel moves between the nearest and the farthest distance, in diagonals of the model.
TEST(CameraControl, TheWheelNeitherLosesAModelNorEntersIt) {
  const auto away = [](double notches) { return moved(aroundModel(), {.wheel = notches}).eye.z; };
  EXPECT_NEAR(away(1e4), kNearest * std::sqrt(12.0), kTolerance);
  EXPECT_NEAR(away(-1e5), kFarthest * std::sqrt(12.0), 10 * kTolerance);
}

// A drag across the window's height moves the point that is orbited by the height that is seen at
// its distance.
TEST(CameraControl, PansWithThePointer) {
  // The camera is 5 away and has half a field of view of 22.5 degrees.
  const double height = 2 * 5 * std::tan(22.5 * kPi / 180);
  const Motion pan{"pan",
                   {.panX = 0.1, .panY = 0.05},
                   0,
                   {-0.1 * height, 0.05 * height, 5},
                   {-0.1 * height, 0.05 * height, 0}};
  expectMoved(aroundModel(), pan);
  expectMoved(CameraControl(Camera(), 1), pan);
}

TEST(CameraControl, NoDragLosesAModel) {
  CameraControl control = aroundModel();
  for (int i = 0; i < 100; ++i) {
    control.step({.turnX = 1234, .turnY = -777, .panX = -50, .panY = 70, .wheel = -3}, 0);
    EXPECT_LE(maxComponent(abs(control.camera().at)), 1 + kTolerance);
  }
}

// The point that is orbited lies at the depth of the model's middle, wherever `at` is.
TEST(CameraControl, OrbitsAModelWhoseCameraLooksAtAPointNearby) {
  Camera camera;
  camera.at = {0, 0, 4.5f};
  const CameraControl control = aroundModel(camera);
  EXPECT_EQ(control.camera().at, camera.at);
  expectNear(moved(control, {.turnX = kQuarterTurn}).eye, {-5, 0, 0});
}

// The corner (1, 1, 1) lies at the border of the picture, so that its height is that of half the
// view.
TEST(CameraControl, FitsAModel) {
  for (const double aspect : {1.0, 2.0, 0.5}) {
    CameraControl control = aroundModel();
    control.step({.panX = 0.3, .wheel = -9}, 0);
    control.fit(aspect);

    const double away = 1 + std::max(1.0, 1 / aspect) / std::tan(kPi / 8);
    expectNear(control.camera().eye, {0, 0, away});
    expectNear(control.camera().at, {0, 0, 0});
  }
}

TEST(CameraControl, ParallelRaysComeCloserToo) {
  Camera camera;
  camera.orthographicHeight = 4;
  CameraControl control = aroundModel(camera);
  control.step({.wheel = 1}, 0);
  EXPECT_NEAR(control.camera().orthographicHeight, 4 * kZoomFactor, kTolerance);
  expectNear(control.camera().eye, {0, 0, 5});

  control.fit(2);
  EXPECT_NEAR(control.camera().orthographicHeight, 2, kTolerance);
}

TEST(CameraControl, WhatIsSeenFromOutsideIsOrbited) {
  Camera camera;
  EXPECT_FALSE(boundsToOrbit(kModel, camera).empty());
  camera.eye = {0.5f, 0, 0};
  EXPECT_TRUE(boundsToOrbit(kModel, camera).empty());
  EXPECT_FALSE(CameraControl(Camera(), 1).orbits());
}

// Shipped scenes are orbited where they are things on a floor, and looked around in where they are
// rooms or landscapes.
TEST(CameraControl, ShippedScenesAreOrbitedOrWalkedIn) {
  for (const std::string name : {"whitted", "glass", "orrery", "matte", "glossy", "effects",
                                 "cornell", "atrium", "landscape?triangles=20000"}) {
    const auto open = openScene({name, nullptr}, {}, false);
    const Box subject = subjectOf(open->scene);
    const bool isWalkedIn = name == "atrium" || name.starts_with("landscape");
    EXPECT_EQ(boundsToOrbit(subject, open->scene.cameras.front()).empty(), isWalkedIn) << name;

    // The floor of orrery is 160 wide; what stands on it fits into 20.
    if (name == "orrery") {
      EXPECT_LT(maxComponent(subject.upper - subject.lower), 20);
    }
  }
}

}  // namespace
}  // namespace whit::view
