// The view of models that have no camera.
#include "make/turntable.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "make/shapes/mesh_builder.h"
#include "pi.h"
#include "scene_builder.h"

namespace whit {
namespace {

using test::sceneOf;
using test::square;

// Returns the unit square about the origin, whose front the transform turns away from +z.
SceneDescription plate(const Affine& turn) {
  SceneDescription scene = sceneOf(square());
  scene.instances[0].toWorld = turn * Affine::translation({-0.5, -0.5, 0});
  return scene;
}

// Returns a box of this half size, whose fronts look inwards if it is a room. `open` has a bit for
// each face that is missing: bit 2 * axis for the lower end, and the next bit for the upper end.
Mesh box(const Vec3f& half, bool room, unsigned open = 0) {
  Mesh mesh;
  mesh.materials = {0};
  for (int i = 0; i < 8; ++i) mesh.positions.push_back(Box{-half, half}.corner(i));

  for (int axis = 0; axis < 3; ++axis) {
    const auto u = 1u << ((axis + 1) % 3), v = 1u << ((axis + 2) % 3), w = 1u << axis;
    for (const unsigned end : {0u, 1u}) {
      if ((open >> (2 * axis)) & (1u << end)) continue;
      const unsigned at = end * w;
      unsigned a = u, b = v;
      if ((end == 0) != room) std::swap(a, b);
      mesh.triangles.push_back({at, at + a, at + a + b});
      mesh.triangles.push_back({at, at + a + b, at + b});
    }
  }

  return mesh;
}

Vec3d towardsEye(const ModelView& view) {
  return normalized(Vec3d(view.camera.eye) - Vec3d(view.camera.at));
}

TEST(ModelViews, ABodyIsSeenFromTheFrontTheRightAndAbove) {
  const Vec3d eye = towardsEye(viewOf(sceneOf(box({1, 1, 1}, false))));
  EXPECT_GT(eye.z, eye.x);
  EXPECT_GT(eye.x, 0);
  EXPECT_GT(eye.y, 0);
}

// However the plate is turned, the view shows at least half of its area.
TEST(ModelViews, APlateIsNotSeenEdgeOn) {
  for (const Vec3d& axis : {Vec3d{0, 1, 0}, Vec3d{1, 0, 0}}) {
    for (const double degrees : {0.0, 90.0, 180.0, 270.0}) {
      if (axis.x != 0 && degrees == 90) continue;  // its front looks down
      const Affine turn = Affine::rotation(axis, degrees);
      const double cosine = dot(towardsEye(viewOf(plate(turn))), turn.vector({0, 0, 1}));
      EXPECT_GT(cosine, 0.5) << axis.x << " " << degrees;
    }
  }

  const Affine down = Affine::rotation({1, 0, 0}, 90);
  SceneDescription scene = plate(down);
  EXPECT_GT(towardsEye(viewOf(scene)).y, 0.2) << "from above nevertheless";

  scene.materials.at(0).doubleSided = false;
  EXPECT_LT(towardsEye(viewOf(scene)).y, -0.2) << "its back is not seen";
}

// Every corner is in the picture, and one of them is near its edge.
TEST(ModelViews, TheModelFillsThePicture) {
  for (const Vec3f& half : {Vec3f{1, 1, 1}, Vec3f{5, 0.2f, 1}, Vec3f{0.1f, 3, 0.1f}}) {
    for (const int width : {480, 100}) {
      SceneDescription scene = sceneOf(box(half, false));
      scene.width = width;
      scene.instances[0].toWorld = Affine::translation({100, -20, 7});
      const ModelView view = viewOf(scene);
      const CameraFrame frame = makeCameraFrame(view.camera, scene.width, scene.height);

      double farthest = 0;
      for (const Vec3f& p : scene.objects[0].meshes[0].positions) {
        const Vec3d way = scene.instances[0].toWorld.point(Vec3d(p)) - frame.eye;
        const double depth = dot(way, normalized(frame.forward)) / length(frame.forward);
        const double x = dot(way, frame.right) / dot(frame.right, frame.right) / depth;
        const double y = dot(way, frame.up) / dot(frame.up, frame.up) / depth;
        EXPECT_GT(depth, 0);
        farthest = std::max({farthest, 2 * std::abs(x) / width, 2 * std::abs(y) / scene.height});
      }

      EXPECT_LT(farthest, 1);
      EXPECT_GT(farthest, 0.9);
    }
  }
}

TEST(ModelViews, AClosedRoomIsSeenFromInside) {
  const ModelView view = viewOf(sceneOf(box({4, 1.5f, 3}, true)));
  EXPECT_TRUE(view.inside);
  for (const Vec3d& p : {Vec3d(view.camera.eye), view.ceiling}) {
    EXPECT_LT(std::abs(p.x), 4);
    EXPECT_LT(std::abs(p.y), 1.5);
    EXPECT_LT(std::abs(p.z), 3);
  }

  EXPECT_GT(view.ceiling.y, 0.5);
  EXPECT_GT(view.camera.eye.x, 1);
}

// The eye avoids furniture.
TEST(ModelViews, ARoomMayBeFurnished) {
  SceneDescription scene = sceneOf(box({4, 2, 4}, true));
  scene.objects[0].meshes.push_back(box({0.5f, 2, 0.5f}, false));
  for (Vec3f& p : scene.objects[0].meshes[1].positions) p += Vec3f(3.4f, 0, 3.4f);
  const ModelView view = viewOf(scene);
  EXPECT_TRUE(view.inside);
  EXPECT_LT(view.camera.eye.x, 2.9f);
}

TEST(ModelViews, NothingElseIsARoom) {
  EXPECT_FALSE(viewOf(sceneOf(box({4, 2, 3}, false))).inside) << "a body";
  for (int face = 0; face < 6; ++face) {
    EXPECT_FALSE(viewOf(sceneOf(box({2, 2, 2}, true, 1u << face))).inside) << "open: " << face;
  }
  EXPECT_FALSE(viewOf(sceneOf(box({9, 0.1f, 9}, true))).inside) << "flat";
}

// Returns an icosphere of radius 1 that is wound inwards and has one material of a file. Its vertex
// normals look out if `normals` is 1, look in if it is -1, and are missing if it is 0.
SceneDescription invertedBall(int normals) {
  const auto [points, triangles] = procedural::icosphereMesh(2);
  Mesh mesh;
  mesh.materials = {0};
  for (const auto& t : triangles) mesh.triangles.push_back({t[0], t[2], t[1]});

  for (const Vec3d& point : points) {
    mesh.positions.emplace_back(point);
    if (normals != 0) mesh.normals.emplace_back(point * static_cast<double>(normals));
  }

  return sceneOf(std::move(mesh));
}

TEST(ModelViews, ABodyThatIsWoundInwardsIsNoRoom) {
  EXPECT_FALSE(viewOf(invertedBall(0)).inside) << "no sign of a room";
  EXPECT_FALSE(viewOf(invertedBall(1)).inside) << "its normals look out";

  SceneDescription two = invertedBall(1);
  two.materials.push_back(two.materials[0]);
  two.objects[0].meshes.push_back(two.objects[0].meshes[0]);
  two.objects[0].meshes[1].materials = {1};
  EXPECT_FALSE(viewOf(two).inside) << "its normals look out";

  SceneDescription bare = sceneOf(box({4, 1.5f, 3}, true));
  bare.materials[0].name = kNoMaterialName;
  EXPECT_FALSE(viewOf(bare).inside) << "a single mesh without a material";
}

TEST(ModelViews, NormalsMaterialsOrFlatWallsMakeARoom) {
  EXPECT_TRUE(viewOf(invertedBall(-1)).inside);
  SceneDescription painted = invertedBall(0);
  painted.materials.push_back(painted.materials[0]);
  Mesh& mesh = painted.objects[0].meshes[0];
  mesh.materials.assign(mesh.triangles.size(), 0);
  mesh.materials[0] = 1;
  EXPECT_TRUE(viewOf(painted).inside);

  SceneDescription turned = sceneOf(box({4, 1.5f, 3}, true));
  turned.instances[0].toWorld = Affine::rotation({0, 1, 0}, 45);
  EXPECT_TRUE(viewOf(turned).inside) << "flat walls";
}

// A mirror image has its fronts on the same side as the original.
TEST(ModelViews, MirroringMakesNoRoom) {
  SceneDescription scene = sceneOf(box({4, 1.5f, 3}, false));
  scene.instances[0].toWorld = Affine::scaling({-1, 1, 1});
  EXPECT_FALSE(viewOf(scene).inside);
  scene.objects[0].meshes[0] = box({4, 1.5f, 3}, true);
  EXPECT_TRUE(viewOf(scene).inside);
}

TEST(ModelViews, TheSideCanBeChosen) {
  SceneDescription scene = sceneOf(box({4, 1.5f, 3}, true));
  scene.viewpoint = Viewpoint::outside;
  EXPECT_GT(viewOf(scene).camera.eye.z, 3);

  scene.objects[0].meshes[0] = box({4, 1.5f, 3}, false);
  scene.viewpoint = Viewpoint::inside;
  const ModelView view = viewOf(scene);
  EXPECT_TRUE(view.inside);
  EXPECT_LT(view.camera.eye.z, 3);
}

// The azimuth turns the usual view about the vertical axis, and leaves its height.
TEST(ModelViews, TheAzimuthCanBeChosen) {
  SceneDescription scene = sceneOf(box({1, 1, 1}, false));
  const double height = towardsEye(viewOf(scene)).y;
  for (const double degrees : {0.0, 30.0, 90.0, 180.0, -135.0}) {
    scene.azimuth = degrees;
    const Vec3d eye = towardsEye(viewOf(scene));
    const double across = std::sqrt(1 - height * height), angle = degrees * kPi / 180;
    EXPECT_NEAR(eye.x, across * std::sin(angle), 1e-6) << degrees;
    EXPECT_NEAR(eye.y, height, 1e-6) << degrees;
    EXPECT_NEAR(eye.z, across * std::cos(angle), 1e-6) << degrees;
  }
}

TEST(ModelViews, ZoomDividesTheDistance) {
  SceneDescription scene = sceneOf(box({1, 2, 3}, false));
  const auto distance = [&](const ModelView& view) {
    return length(Vec3d(view.camera.eye) - Vec3d(view.camera.at));
  };
  const ModelView usual = viewOf(scene);
  const Turntable usualTurn = aroundModel(scene, usual, 48, 30);
  for (const double zoom : {0.5, 1.25, 3.0}) {
    scene.zoom = zoom;
    const ModelView view = viewOf(scene);
    EXPECT_NEAR(distance(view) * zoom, distance(usual), 1e-5);
    EXPECT_EQ(view.camera.at, usual.camera.at);

    const Turntable turn = aroundModel(scene, view, 48, 30);
    const auto away = [](const Turntable& t) { return length(Vec3d(t.camera.eye) - t.pivot); };
    EXPECT_NEAR(away(turn) * zoom, away(usualTurn), 1e-5);
  }
}

// In a room the eye stands where the azimuth meets the walls, and zoom enlarges the picture.
TEST(ModelViews, ARoomHasAzimuthAndZoomToo) {
  SceneDescription scene = sceneOf(box({4, 1.5f, 3}, true));
  const Camera usual = viewOf(scene).camera;
  scene.azimuth = -90;
  scene.zoom = 2;
  const ModelView view = viewOf(scene);
  EXPECT_TRUE(view.inside);
  EXPECT_NEAR(view.camera.eye.x, -0.85 * 4, 1e-5);
  EXPECT_NEAR(view.camera.eye.z, 0, 1e-5);
  const auto half = [](float fov) { return std::tan(double{fov} * kPi / 360); };
  EXPECT_NEAR(half(usual.fov) / half(view.camera.fov), 2, 1e-5);
}

// The plate is 4 by 2 at a distance of 5. The eye moves sideways, step by step.
TEST(ModelViews, ACameraSeesWhatOverlapsItsPicture) {
  SceneDescription scene = sceneOf(square());
  scene.instances[0].toWorld = Affine::scaling({4, 2, 1}) * Affine::translation({-0.5, -0.5, 0});
  scene.width = scene.height = 100;
  Camera camera;
  camera.fov = 60;

  // Half of the picture is 5 tan 30 = 2.887 wide, and half of the plate is 2 wide.
  for (const auto& [x, sees] : {std::pair{0.0f, true}, {4.8f, true}, {4.95f, false}}) {
    camera.eye = {x, 0, 5};
    camera.at = {x, 0, 0};
    EXPECT_EQ(seesSomething(scene, camera), sees) << x;
  }

  camera.eye = {0, 0, 5};
  camera.at = {0, 0, 10};
  EXPECT_FALSE(seesSomething(scene, camera)) << "it lies behind";

  camera.at = {0, 0, 0};
  camera.orthographicHeight = 2;
  for (const auto& [x, sees] : {std::pair{2.9f, true}, {3.1f, false}}) {
    camera.eye = {x, 0, 5};
    camera.at = {x, 0, 0};
    EXPECT_EQ(seesSomething(scene, camera), sees) << x;
  }
}

TEST(ModelViews, NothingToSeeIsNoView) {
  EXPECT_EQ(viewOf(SceneDescription()).radius, 0);
  SceneDescription broken = sceneOf(square());
  broken.objects[0].meshes[0].triangles = {{0, 1, 7}, {0, 0, 0}};
  broken.objects[0].meshes[0].positions[1].x = std::nanf("");
  EXPECT_EQ(viewOf(broken).radius, 0);
}

}  // namespace
}  // namespace whit
