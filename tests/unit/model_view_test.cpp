// The view of models that have no camera.
#include "make/turntable.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "farthest_in_picture.h"
#include "make/shapes/mesh_builder.h"
#include "pi.h"
#include "scene_builder.h"
#include "verify/scene_builder.h"

namespace whit {
namespace {

using namespace test;

// Returns the unit square about the origin, whose front the transform turns away from +z.
SceneDescription plate(const Affine& turn) {
  return placedAs(square(), turn * Affine::translation({-0.5, -0.5, 0}));
}

// Returns a box of this half size, whose fronts look inwards if it is a room.
Mesh box(const Vec3f& half, bool room = false) {
  Mesh mesh = verify::box(-half, half, 0);
  for (auto& [a, b, c] : mesh.triangles) {
    if (room) std::swap(b, c);
  }
  return mesh;
}

Vec3d towardsEye(const SceneDescription& scene) {
  const Camera camera = viewOf(scene).camera;
  return normalized(Vec3d(camera.eye) - Vec3d(camera.at));
}

const Vec3f kRoom{4, 1.5f, 3};

SceneDescription room() { return sceneOf(box(kRoom, true)); }

TEST(ModelViews, ABodyIsSeenFromTheFrontTheRightAndAbove) {
  const Vec3d eye = towardsEye(sceneOf(box({1, 1, 1})));
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
      const double cosine = dot(towardsEye(plate(turn)), turn.vector({0, 0, 1}));
      EXPECT_GT(cosine, 0.5) << axis.x << " " << degrees;
    }
  }

  SceneDescription scene = plate(Affine::rotation({1, 0, 0}, 90));
  EXPECT_GT(towardsEye(scene).y, 0.2) << "from above nevertheless";

  scene.materials.at(0).doubleSided = false;
  EXPECT_LT(towardsEye(scene).y, -0.2) << "its back is not seen";
}

// Every corner is in the picture, and one of them is near its edge.
TEST(ModelViews, TheModelFillsThePicture) {
  const Affine place = Affine::translation({100, -20, 7});
  for (const Vec3f& half : {Vec3f{1, 1, 1}, Vec3f{5, 0.2f, 1}, Vec3f{0.1f, 3, 0.1f}}) {
    for (const int width : {480, 100}) {
      SceneDescription scene = placedAs(box(half), place);
      scene.width = width;
      std::vector<Vec3d> corners;
      for (const Vec3f& p : box(half).positions) corners.push_back(place.point(Vec3d(p)));

      const double farthest =
          farthestInPicture(makeCameraFrame(viewOf(scene).camera, width, scene.height), corners);
      EXPECT_LT(farthest, 1) << width;
      EXPECT_GT(farthest, 0.9) << width;
    }
  }
}

TEST(ModelViews, AClosedRoomIsSeenFromInside) {
  const ModelView view = viewOf(room());
  EXPECT_TRUE(view.inside);
  for (const Vec3d& p : {Vec3d(view.camera.eye), view.ceiling}) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_LT(std::abs(p[axis]), kRoom[axis]);
  }

  EXPECT_GT(view.ceiling.y, 0.5);
  EXPECT_GT(view.camera.eye.x, 1);
}

// The eye avoids furniture.
TEST(ModelViews, ARoomMayBeFurnished) {
  Mesh cupboard = box({0.5f, 2, 0.5f});
  for (Vec3f& p : cupboard.positions) p += Vec3f(3.4f, 0, 3.4f);
  const ModelView view = viewOf(sceneOf(box({4, 2, 4}, true), cupboard));
  EXPECT_TRUE(view.inside);
  EXPECT_LT(view.camera.eye.x, 2.9f);
}

TEST(ModelViews, NothingElseIsARoom) {
  EXPECT_FALSE(viewOf(sceneOf(box({4, 2, 3}))).inside) << "a body";
  for (int face = 0; face < 6; ++face) {
    Mesh open = box({2, 2, 2}, true);
    const auto first = open.triangles.begin() + 2 * face;
    open.triangles.erase(first, first + 2);
    EXPECT_FALSE(viewOf(sceneOf(open)).inside) << "open: " << face;
  }
  EXPECT_FALSE(viewOf(sceneOf(box({9, 0.1f, 9}, true))).inside) << "flat";
}

// Returns an icosphere of radius 1 that is wound inwards and has one material of a file. Its vertex
// normals look out if `normals` is 1, look in if it is -1, and are missing if it is 0.
SceneDescription invertedBall(double normals) {
  const auto [points, triangles] = procedural::icosphereMesh(2);
  Mesh mesh;
  mesh.materials = {0};
  for (const auto& t : triangles) mesh.triangles.push_back({t[0], t[2], t[1]});

  for (const Vec3d& point : points) {
    mesh.positions.emplace_back(point);
    if (normals != 0) mesh.normals.emplace_back(point * normals);
  }

  return sceneOf(mesh);
}

TEST(ModelViews, ABodyThatIsWoundInwardsIsNoRoom) {
  EXPECT_FALSE(viewOf(invertedBall(0)).inside) << "no sign of a room";
  SceneDescription two = invertedBall(1);
  EXPECT_FALSE(viewOf(two).inside) << "its normals look out";

  two.materials.resize(2, two.materials[0]);
  two.objects[0].meshes.resize(2, two.objects[0].meshes[0]);
  two.objects[0].meshes[1].materials = {1};
  EXPECT_FALSE(viewOf(two).inside) << "its normals look out";

  SceneDescription bare = room();
  bare.materials[0].name = kNoMaterialName;
  EXPECT_FALSE(viewOf(bare).inside) << "a single mesh without a material";
}

TEST(ModelViews, NormalsMaterialsOrFlatWallsMakeARoom) {
  EXPECT_TRUE(viewOf(invertedBall(-1)).inside);
  SceneDescription painted = invertedBall(0);
  painted.materials.resize(2, painted.materials[0]);
  Mesh& mesh = painted.objects[0].meshes[0];
  mesh.materials.assign(mesh.triangles.size(), 0);
  mesh.materials[0] = 1;
  EXPECT_TRUE(viewOf(painted).inside);

  const Affine turn = Affine::rotation({0, 1, 0}, 45);
  EXPECT_TRUE(viewOf(placedAs(box(kRoom, true), turn)).inside) << "flat walls";
}

// A mirror image has its fronts on the same side as the original.
TEST(ModelViews, MirroringMakesNoRoom) {
  for (const bool isRoom : {false, true}) {
    const Affine mirror = Affine::scaling({-1, 1, 1});
    EXPECT_EQ(viewOf(placedAs(box(kRoom, isRoom), mirror)).inside, isRoom);
  }
}

TEST(ModelViews, TheSideCanBeChosen) {
  SceneDescription scene = room();
  scene.viewpoint = Viewpoint::outside;
  EXPECT_GT(viewOf(scene).camera.eye.z, 3);

  scene.objects[0].meshes[0] = box(kRoom);
  scene.viewpoint = Viewpoint::inside;
  const ModelView view = viewOf(scene);
  EXPECT_TRUE(view.inside);
  EXPECT_LT(view.camera.eye.z, 3);
}

// The azimuth turns the usual view about the vertical axis, and leaves its height.
TEST(ModelViews, TheAzimuthCanBeChosen) {
  SceneDescription scene = sceneOf(box({1, 1, 1}));
  const double height = towardsEye(scene).y;
  for (const double degrees : {0.0, 30.0, 90.0, 180.0, -135.0}) {
    scene.azimuth = degrees;
    const Vec3d eye = towardsEye(scene);
    const double across = std::sqrt(1 - height * height), angle = degrees * kPi / 180;
    EXPECT_NEAR(eye.x, across * std::sin(angle), 1e-6) << degrees;
    EXPECT_NEAR(eye.y, height, 1e-6) << degrees;
    EXPECT_NEAR(eye.z, across * std::cos(angle), 1e-6) << degrees;
  }
}

TEST(ModelViews, ZoomDividesTheDistance) {
  SceneDescription scene = sceneOf(box({1, 2, 3}));
  const auto distances = [&](double zoom) {
    scene.zoom = zoom;
    const ModelView view = viewOf(scene);
    EXPECT_EQ(view.camera.at, viewOf(sceneOf(box({1, 2, 3}))).camera.at);
    const Turntable turn = aroundModel(scene, view, 48, 30);
    return std::array{length(Vec3d(view.camera.eye) - Vec3d(view.camera.at)),
                      length(Vec3d(turn.camera.eye) - turn.pivot)};
  };

  const auto usual = distances(1);
  for (const double zoom : {0.5, 1.25, 3.0}) {
    const auto zoomed = distances(zoom);
    for (const std::size_t i : {0, 1}) EXPECT_NEAR(zoomed[i] * zoom, usual[i], 1e-5) << zoom;
  }
}

// In a room the eye stands where the azimuth meets the walls, and zoom enlarges the picture.
TEST(ModelViews, ARoomHasAzimuthAndZoomToo) {
  SceneDescription scene = room();
  const Camera usual = viewOf(scene).camera;
  scene.azimuth = -90;
  scene.zoom = 2;
  const ModelView view = viewOf(scene);
  EXPECT_TRUE(view.inside);
  EXPECT_NEAR(view.camera.eye.x, -0.85 * 4, 1e-5);
  EXPECT_NEAR(view.camera.eye.z, 0, 1e-5);
  const auto half = [](float fov) { return std::tan(fov * kPi / 360); };
  EXPECT_NEAR(half(usual.fov) / half(view.camera.fov), 2, 1e-5);
}

// The plate is 4 by 2 at a distance of 5. The eye moves sideways, step by step.
TEST(ModelViews, ACameraSeesWhatOverlapsItsPicture) {
  SceneDescription scene = plate(Affine::scaling({4, 2, 1}));
  scene.width = scene.height = 100;
  Camera camera;
  camera.fov = 60;
  const auto seesFrom = [&](float x) {
    camera.eye = {x, 0, 5};
    camera.at = {x, 0, 0};
    return seesSomething(scene, camera);
  };

  // Half of the picture is 5 tan 30 = 2.887 wide, and half of the plate is 2 wide.
  EXPECT_TRUE(seesFrom(0) && seesFrom(4.8f));
  EXPECT_FALSE(seesFrom(4.95f));
  camera.at.z = 10;
  EXPECT_FALSE(seesSomething(scene, camera)) << "it lies behind";

  camera.orthographicHeight = 2;
  EXPECT_TRUE(seesFrom(2.9f));
  EXPECT_FALSE(seesFrom(3.1f));
}

TEST(ModelViews, AnExactEllipsoidIsSeenAsWhatItIs) {
  const Vec3d center{100, -20, 7}, axes{2, 1, 3};
  for (const std::size_t spheres : {1u, 2000u}) {
    Mesh mesh;
    mesh.materials = {0};
    mesh.spheres.assign(spheres, Affine::scaling(axes));
    const SceneDescription scene = placedAs(mesh, Affine::translation(center));

    const ModelView view = viewOf(scene);
    EXPECT_FALSE(view.inside);
    EXPECT_LT(length(view.center - center), 1e-5);
    EXPECT_NEAR(view.radius, length(axes), 1e-5);

    Camera camera = view.camera;
    EXPECT_TRUE(seesSomething(scene, camera));
    camera.at = camera.eye + (camera.eye - camera.at);
    EXPECT_FALSE(seesSomething(scene, camera));
  }
}

TEST(ModelViews, NothingToSeeIsNoView) {
  EXPECT_EQ(viewOf(SceneDescription()).radius, 0);
  SceneDescription broken = sceneOf(square());
  broken.objects[0].meshes[0].triangles = {{0, 1, 7}, {0, 0, 0}};
  broken.objects[0].meshes[0].positions[1].x = NAN;
  EXPECT_EQ(viewOf(broken).radius, 0);
}

}  // namespace
}  // namespace whit
