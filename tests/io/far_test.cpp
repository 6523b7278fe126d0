// Models far from the origin keep their shapes: positions are moved before they are rounded.
#include "bake/scene.h"
#include "gltf_files.h"
#include "scene_files.h"

namespace whit {
namespace {

using FarModels = GltfTest;

// Corners of the first triangle in the world. Single precision holds 4000000.25 as is, and neither
// 4000000.1 nor 4000000.35: its step is 0.25 there.
const std::string kFarObj =
    "v 4000000.1 500000.2 10\nv 4000001.1 500000.2 10\nv 4000000.1 500001.2 10\nf 1 2 3\n";

std::array<Vec3d, 3> cornersOf(const SceneDescription& scene) {
  std::array<Vec3d, 3> corners;
  const Instance& instance = scene.instances.at(0);
  const Mesh& mesh = scene.objects.at(instance.object).meshes.at(0);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d inScene(Vec3f(instance.toWorld.point(Vec3d(mesh.positions[mesh.triangles[0][i]]))));
    corners[i] = scene.inFile(inScene);
  }
  return corners;
}

// Edges of a right-angled triangle of legs 1, where the file says they are. The tolerance is the
// rounding of coordinates below 2.
void expectLegsOfOne(const SceneDescription& scene, const Vec3d& first) {
  constexpr double kRounding = 1.2e-7;
  EXPECT_NE(scene.origin, Vec3d());
  const std::array corners = cornersOf(scene);
  EXPECT_LT(maxComponent(abs(corners[0] - first)), kRounding);
  EXPECT_NEAR(length(corners[1] - corners[0]), 1, 2 * kRounding);
  EXPECT_NEAR(length(corners[2] - corners[0]), 1, 2 * kRounding);
}

TEST_F(FarModels, ObjKeepsItsEdges) {
  options_.settings = {"/up=\"y\""};
  expectLegsOfOne(load(save("far.obj", kFarObj)), {4000000.1, 500000.2, 10});
  ASSERT_EQ(warnings_.entries().size(), 1u);
  EXPECT_EQ(warnings_.entries().begin()->first,
            "model far from the origin: origin moved by 4000000.5,500000.75,10");
}

TEST_F(FarModels, PlyKeepsItsEdges) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
      "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  options_.settings = {"/up=\"y\""};
  expectLegsOfOne(load(save("far.ply", header + "4000000.1 500000.2 10\n4000001.1 500000.2 10\n"
                                                "4000000.1 500001.2 10\n3 0 1 2\n")),
                  {4000000.1, 500000.2, 10});
}

TEST_F(FarModels, NodesOfGltfKeepEdgesCamerasAndLights) {
  GltfBuilder b;
  const std::string position = std::to_string(b.positions(kTriangleXyz));
  const SceneDescription scene = loadText(
      b.json("\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":" + position +
             "}}]}],\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1}}],"
             "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\"}]}},"
             "\"nodes\":[{\"translation\":[4000000.1,0,0],\"children\":[1,2,3]},{\"mesh\":0},"
             "{\"camera\":0,\"translation\":[0,0,5]},"
             "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}},\"translation\":[0,3,0]}]"));
  ASSERT_NE(scene.origin, Vec3d());
  constexpr double kRounding = 5e-7;  // of coordinates below 8
  const auto expectAt = [&](const Vec3f& found, const Vec3d& right) {
    EXPECT_LT(maxComponent(abs(scene.inFile(Vec3d(found)) - right)), kRounding);
  };
  const std::array corners = cornersOf(scene);
  expectAt(Vec3f(corners[0] - scene.origin),
           Vec3d(kTriangleXyz[0], kTriangleXyz[1], kTriangleXyz[2]) + Vec3d(4000000.1, 0, 0));
  expectAt(scene.cameras.at(0).eye, {4000000.1, 0, 5});
  expectAt(scene.lights.at(0).position, {4000000.1, 3, 0});
}

TEST_F(FarModels, SceneFilesBringThemBack) {
  save("far.obj", kFarObj);
  const SceneDescription scene = loadMembers(
      "\"scene\": [{\"model\": \"far.obj\", \"transform\": {\"translate\": [-4000000.1, -500000.2, "
      "-10]}}]");
  EXPECT_EQ(scene.origin, Vec3d());
  EXPECT_TRUE(warnings_.entries().empty());
  const std::array corners = cornersOf(scene);
  EXPECT_LT(maxComponent(abs(corners[0])), 1e-7);
  EXPECT_LT(maxComponent(abs(corners[1] - Vec3d(1, 0, 0))), 1e-7);
}

TEST_F(FarModels, SceneFilesSayThatTheyAreFar) {
  save("far.obj", kFarObj);
  const SceneDescription scene = loadMembers("\"scene\": [{\"model\": \"far.obj\"}]");
  EXPECT_EQ(scene.origin, Vec3d());
  ASSERT_EQ(warnings_.entries().size(), 1u);
  EXPECT_TRUE(warnings_.entries().begin()->first.starts_with("scene far from the origin"));
}

TEST_F(FarModels, SettingsOfLightsAreInCoordinatesOfTheFile) {
  options_.settings = {"/up=\"y\"", "/lights/0/position=[4000000.1, 500000.2, 14]"};
  const SceneDescription scene = load(save("far.obj", kFarObj));
  const Vec3d position = scene.inFile(Vec3d(scene.lights.at(0).position));
  EXPECT_LT(maxComponent(abs(position - Vec3d(4000000.1, 500000.2, 14))), 5e-7);
}

// At 30 sizes nothing is gained that is seen.
TEST_F(FarModels, NearerOnesStay) {
  EXPECT_EQ(loadObj("v 40 0 0\nv 41 0 0\nv 40 1 0\nf 1 2 3\n").origin, Vec3d());
  EXPECT_EQ(loadObj("v 50 0 0\nv 51 0 0\nv 50 1 0\nf 1 2 3\n").origin, Vec3d(50.5, 0.5, 0));
}

}  // namespace
}  // namespace whit
