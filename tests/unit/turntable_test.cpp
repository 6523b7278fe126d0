#include "make/turntable.h"

#include <cmath>

#include "pi.h"
#include "scene_builder.h"

namespace whit {
namespace {

using test::sceneOf;
using test::square;

void expectNear(const Vec3f& found, const Vec3d& wanted, double bound) {
  EXPECT_NEAR(found.x, wanted.x, bound);
  EXPECT_NEAR(found.y, wanted.y, bound);
  EXPECT_NEAR(found.z, wanted.z, bound);
}

Camera lookingAt(const Vec3f& eye, const Vec3f& at) {
  Camera camera;
  camera.eye = eye;
  camera.at = at;
  return camera;
}

TEST(Turntable, TheEyeGoesAroundOnACircle) {
  const Turntable turntable = aroundTarget(lookingAt({5, 3, 2}, {1, 1, 2}));
  for (int k = 0; k < 12; ++k) {
    const double angle = 2 * kPi * k / 12;
    const Camera camera = turned(turntable, k / 12.0);
    expectNear(camera.eye, {1 + 4 * std::cos(angle), 3, 2 - 4 * std::sin(angle)}, 2e-6);
    expectNear(camera.at, {1, 1, 2}, 1e-6);
    expectNear(camera.up, {0, 1, 0}, 1e-7);
    EXPECT_EQ(camera.fov, turntable.camera.fov);
  }
}

TEST(Turntable, WholeTurnsEndWhereTheyBegan) {
  const Turntable turntable = aroundTarget(lookingAt({5, 3, 2}, {1, 1, 2}));
  for (const double turns : {0.0, 1.0, -1.0, 7.0}) {
    EXPECT_TRUE(sameView(turned(turntable, turns), turntable.camera));
  }
  EXPECT_TRUE(sameView(turned(turntable, -0.25), turned(turntable, 0.75)));
}

TEST(Turntable, TurnsInTheDirectionUp) {
  Camera camera = lookingAt({0, 3, 0}, {0, 0, 0});
  camera.up = {0, 0, 2};
  expectNear(turned(aroundTarget(camera), 0.25).eye, {-3, 0, 0}, 1e-6);
}

// Every corner stays in the picture, and one comes as near to its border as the margin allows.
TEST(Turntable, AllOfTheModelStaysInThePicture) {
  Mesh mesh = square();
  mesh.positions = {{-3, 0, 0}, {1, 0, 0.5f}, {1, 4, 0}, {-3, 4, -0.5f}};
  const SceneDescription scene = sceneOf(mesh);

  for (const auto& [width, height] : {std::pair{480, 300}, std::pair{200, 400}}) {
    const Turntable turntable = aroundModel(scene, viewOf(scene), width, height);
    double widest = 0;
    for (int k = 0; k < 96; ++k) {
      const CameraFrame frame = makeCameraFrame(turned(turntable, k / 96.0), width, height);
      for (const Vec3f& corner : mesh.positions) {
        const Vec3d p = Vec3d(corner) - frame.eye;
        const double depth = dot(p, frame.forward) / dot(frame.forward, frame.forward);
        ASSERT_GT(depth, 0);

        const Vec3d across = p / depth;
        widest = std::max(
            {widest,
             std::abs(dot(across, frame.right)) / dot(frame.right, frame.right) / (width / 2.0),
             std::abs(dot(across, frame.up)) / dot(frame.up, frame.up) / (height / 2.0)});
      }
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
  expectNear(camera.eye + turntable.camera.eye, {21, 2 * double{camera.eye.y}, 0}, 1e-4);
  expectNear(camera.at, turntable.pivot, 1e-6);
}

}  // namespace
}  // namespace whit
