#include "make/turntable.h"

#include <cmath>

#include "farthest_in_picture.h"
#include "pi.h"
#include "rounding.h"
#include "scene_builder.h"

namespace whit {
namespace {

using namespace test;

const Camera kCamera{.eye = {5, 3, 2}, .at = {1, 1, 2}};

TEST(Turntable, TheEyeGoesAroundOnACircle) {
  const Turntable turntable = aroundTarget(kCamera);
  for (int k = 0; k < 12; ++k) {
    const double angle = 2 * kPi * k / 12;
    const Camera camera = turned(turntable, k / 12.0);
    expectNear(Vec3d(camera.eye), {1 + 4 * std::cos(angle), 3, 2 - 4 * std::sin(angle)}, 2e-6);
    expectNear(Vec3d(camera.at), {1, 1, 2}, 1e-6);
    expectNear(Vec3d(camera.up), {0, 1, 0}, 1e-7);
    EXPECT_EQ(camera.fov, turntable.camera.fov);
  }
}

TEST(Turntable, WholeTurnsEndWhereTheyBegan) {
  const Turntable turntable = aroundTarget(kCamera);
  for (const double turns : {0.0, 1.0, -1.0, 7.0}) {
    EXPECT_TRUE(sameView(turned(turntable, turns), turntable.camera));
  }
  EXPECT_TRUE(sameView(turned(turntable, -0.25), turned(turntable, 0.75)));
}

TEST(Turntable, TurnsInTheDirectionUp) {
  const Camera camera{.eye = {0, 3, 0}, .at = {0, 0, 0}, .up = {0, 0, 2}};
  expectNear(Vec3d(turned(aroundTarget(camera), 0.25).eye), {-3, 0, 0}, 1e-6);
}

// Every corner stays in the picture, and one comes as near to its border as the margin allows.
TEST(Turntable, AllOfTheModelStaysInThePicture) {
  Mesh mesh = square();
  mesh.positions = {{-3, 0, 0}, {1, 0, 0.5f}, {1, 4, 0}, {-3, 4, -0.5f}};
  const SceneDescription scene = sceneOf(mesh);

  const std::vector<Vec3d> corners(mesh.positions.begin(), mesh.positions.end());
  for (const auto& [width, height] : {std::pair{480, 300}, {200, 400}}) {
    const Turntable turntable = aroundModel(scene, viewOf(scene), width, height);
    double widest = 0;
    for (int k = 0; k < 96; ++k) {
      const CameraFrame frame = makeCameraFrame(turned(turntable, k / 96.0), width, height);
      widest = std::max(widest, farthestInPicture(frame, corners));
    }
    EXPECT_LT(widest, 1) << width;
    EXPECT_GT(widest, 0.85) << width;
  }
}

TEST(Turntable, GoesAroundTheMiddleOfTheModel) {
  Mesh mesh = square();
  for (Vec3f& p : mesh.positions) p += Vec3f{10, 0, 0};
  const SceneDescription scene = sceneOf(mesh);
  const Turntable turntable = aroundModel(scene, viewOf(scene), 480, 300);
  EXPECT_EQ(turntable.pivot, (Vec3d{10.5, 0.5, 0}));

  const Camera camera = turned(turntable, 0.5);
  expectNear(Vec3d(camera.eye + turntable.camera.eye), {21, 2 * camera.eye.y, 0}, 1e-4);
  expectNear(Vec3d(camera.at), turntable.pivot, 1e-6);
}

}  // namespace
}  // namespace whit
