// Models far from the origin keep their shapes: positions are moved before they are rounded.
#include "bake/edit_scene.h"
#include "gltf_files.h"
#include "io/assimp/assimp_model.h"

namespace whit {
namespace {

class FarModels : public GltfTest {
 protected:
  // Loads a file with a triangle, a camera and a light, which these nodes show.
  SceneDescription loadNodes(const std::string& nodes) {
    return loadText(json("'meshes':[{'primitives':[" + triangle() +
                         "]}],'cameras':[{'type':'perspective','perspective':{'yfov':1}}],"
                         "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point'}]}},"
                         "'nodes':[" +
                         nodes + "]"));
  }

  static constexpr double kRounding = 5e-7;  // of coordinates below 8
};

// Corners of the first triangle in the world. Single precision holds 4000000.25 as is, and neither
// 4000000.1 nor 4000000.35: its step is 0.25 there.
const std::string kFarObj =
    "v 4000000.1 500000.2 10\nv 4000001.1 500000.2 10\nv 4000000.1 500001.2 10\nf 1 2 3\n";

const Vec3d kFirst{4000000.1, 500000.2, 10};

std::array<Vec3d, 3> cornersOf(const SceneDescription& scene) {
  std::array<Vec3d, 3> corners;
  for (const auto i : indices(3)) {
    corners[i] = scene.inFile(Vec3d(Vec3f(cornerOf(scene, i))));
  }
  return corners;
}

// Edges of a right-angled triangle of legs 1, where the file says they are. The tolerance is the
// rounding of coordinates below 2.
void expectLegsOfOne(const SceneDescription& scene, const Vec3d& first) {
  constexpr double kRounding = 1.2e-7;
  EXPECT_NE(scene.origin, Vec3d());
  const std::array corners = cornersOf(scene);
  expectNearInFloat(corners[0], first, kRounding);
  EXPECT_NEAR(length(corners[1] - corners[0]), 1, 2 * kRounding);
  EXPECT_NEAR(length(corners[2] - corners[0]), 1, 2 * kRounding);
}

TEST_F(FarModels, ObjAndPlyKeepTheirEdges) {
  options_.settings = {"/up='y'"};
  expectLegsOfOne(loadObj(kFarObj), kFirst);
  EXPECT_EQ(kinds(), "model far from the origin: origin moved by 4000000.5,500000.75,0\n");

  // Vertices that no face uses are not part of the model, wherever they are.
  const std::string strays = "v 0 0 0\n" + kFarObj + "v 1e7 0 0\n";
  expectLegsOfOne(loadObj(replaced(strays, "f 1 2 3", "f -3 -2 -1")), kFirst);

  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
      "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "4000000.1 500000.2 10\n4000001.1 500000.2 10\n4000000.1 500001.2 10\n0 0 0\n3 0 1 2\n";
  expectLegsOfOne(load(save("strays.ply", ply)), kFirst);
  const std::string whole = replaced(replaced(ply, "vertex 4", "vertex 3"), "0 0 0\n", "");
  expectLegsOfOne(load(save("far.ply", whole)), kFirst);
}

// Moved, it stands on both sides of the plane y = 0, which its file does not say.
TEST_F(FarModels, ObjIsNotTurnedForBeingMoved) {
  load(save("tall.obj", "v 0 500000 0\nv 1 500001 0\nv 0.5 500000.5 2\nf 1 2 3\n"));
  EXPECT_EQ(kinds(), "model far from the origin: origin moved by 0,500000.5,0\n");
}

TEST_F(FarModels, NodesOfGltfKeepEdgesCamerasAndLights) {
  const SceneDescription scene = loadNodes(
      "{'translation':[4000000.1,0,0],'children':[1,2,3]},{'mesh':0},"
      "{'camera':0,'translation':[0,0,5]},"
      "{'extensions':{'KHR_lights_punctual':{'light':0}},'translation':[0,3,0]}");

  ASSERT_NE(scene.origin, Vec3d());
  const auto expectAt = [&](const Vec3f& found, const Vec3d& right) {
    expectNearInFloat(scene.inFile(Vec3d(found)), right, kRounding);
  };

  const std::array corners = cornersOf(scene);
  expectAt(Vec3f(corners[0] - scene.origin),
           Vec3d(kTriangleXyz[0], kTriangleXyz[1], kTriangleXyz[2]) + Vec3d(4000000.1, 0, 0));
  expectAt(scene.cameras.at(0).eye, {4000000.1, 0, 5});
  expectAt(scene.lights.at(0).position, {4000000.1, 3, 0});
}

// A joint has the vertices of a skin, and a morph target bends it, at the start and in motion.
TEST_F(FarModels, BentMeshesOfGltfKeepTheirEdges) {
  positions(kTriangleXyz);
  positions({0, 0, 0, 2, 0, 0, 0, 0, 0});  // moved by the target
  add("VEC4", std::vector<std::uint16_t>(12));
  floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  floats("SCALAR", {0, 1});
  positions({4e6f, 0, 0, 4e6f, 1, 0});
  const std::string text = json(
      "'meshes':[{'weights':[0.5],'primitives':[{'attributes':{'POSITION':0,'JOINTS_0':2,'WEIGHTS_"
      "0':3},'targets':[{'POSITION':1}]}]}],'skins':[{'joints':[1]}],'nodes':[{'mesh':0,'skin':0},{"
      "'children':[2]},{'mesh':0}],'animations':[{'samplers':[{'input':4,'output':5}],'channels':[{"
      "'sampler':0,'target':{'node':1,'path':'translation'}}]}]");
  options_.instant.plays = true;
  Scene scene = bake(loadText(text));
  ASSERT_EQ(scene.origin, Vec3d(4e6 + 1, 0, 0));

  for (const double seconds : {0.0, 0.5}) {
    moveScene(scene, seconds);
    ASSERT_EQ(scene.instances.size(), 2u);
    for (const InstanceRecord& instance : scene.instances) {
      const std::vector<Vec3f>& corners = scene.geometries[instance.geometry].position;
      const Vec3d corner = instance.toWorld.point(Vec3d(corners.at(1)));
      expectNearInFloat(scene.inFile(corner), {4e6 + 2, seconds, 0}, kRounding);
    }
  }
}

// Cameras and lights that an animation carries, and what is placed by hand.
TEST_F(FarModels, MovingNodesOfGltfAreInCoordinatesOfTheFile) {
  options_.instant.movable = {"/nodes/1"};
  Scene scene = bake(loadNodes(
      "{'translation':[4000000.1,0,0],'mesh':0},{'translation':[4000000.1,2,0],'camera':0,"
      "'extensions':{'KHR_lights_punctual':{'light':0}},'children':[2]},{'mesh':0}"));
  ASSERT_NE(scene.origin, Vec3d());

  const auto expectAt = [&](double y) {
    const Vec3d right{4000000.1, y, 0};
    expectNearInFloat(scene.inFile(scene.instances.at(1).toWorld.p), right, kRounding);
    expectNearInFloat(scene.inFile(Vec3d(scene.cameras.at(0).eye)), right, kRounding);
    expectNearInFloat(scene.inFile(Vec3d(scene.lights.at(0).position)), right, kRounding);
  };
  expectAt(2);
  setPlace(scene, "/nodes/1", Affine::translation({4000000.1, 3, 0}));
  moveScene(scene, 0);
  expectAt(3);
}

// As kFarObj, by assimp, which writes transforms in single precision: the edges stay, and only the
// place is rounded.
TEST_F(FarModels, NodesOfColladaKeepTheirEdges) {
  const std::string far =
      "<?xml version='1.0'?> <COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
      "version='1.4.1'> <asset><up_axis>Y_UP</up_axis></asset><library_geometries><geometry "
      "id='g'><mesh> <source id='v'><float_array id='a' count='9'>0.1 0 0 1.1 0 0 0.1 1 "
      "0</float_array> <technique_common><accessor source='#a' count='3' stride='3'><param "
      "name='X' type='float'/> <param name='Y' type='float'/><param name='Z' "
      "type='float'/></accessor></technique_common> </source><vertices id='w'><input "
      "semantic='POSITION' source='#v'/></vertices> <triangles count='1'><input semantic='VERTEX' "
      "source='#w' offset='0'/><p>0 1 2</p></triangles> "
      "</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id='s'> <node "
      "id='n'><translate>4000000 0 0</translate><instance_geometry url='#g'/></node> "
      "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#s'/></scene> "
      "</COLLADA>";

  if (convertByAssimp("far.dae", far, 1 << 30).glb.empty())
    GTEST_SKIP() << "built without libassimp";
  expectLegsOfOne(load(save("far.dae", far)), {4000000.1, 0, 0});
}

TEST_F(FarModels, SceneFilesBringThemBack) {
  save("far.obj", kFarObj);
  const SceneDescription scene = loadMembers(
      "'scene': [{'model': 'far.obj', 'transform': {'translate': [-4000000.1, -500000.2, -10]}}]");
  EXPECT_EQ(scene.origin, Vec3d());
  expectNoWarnings();
  const std::array corners = cornersOf(scene);
  expectNearInFloat(corners[0], {}, 1e-7);
  expectNearInFloat(corners[1], {1, 0, 0}, 1e-7);
}

TEST_F(FarModels, SceneFilesSayThatTheyAreFar) {
  save("far.obj", kFarObj);
  const SceneDescription scene = loadMembers("'scene': [{'model': 'far.obj'}]");
  EXPECT_EQ(scene.origin, Vec3d());
  ASSERT_EQ(warnings_.entries().size(), 1u);
  expectLike(kinds(), "scene far from the origin*");
}

TEST_F(FarModels, SettingsOfLightsAreInCoordinatesOfTheFile) {
  options_.settings = {"/up='y'", "/lights/0/position=[4000000.1, 500000.2, 14]"};
  const SceneDescription scene = loadObj(kFarObj);
  const Vec3d position = scene.inFile(Vec3d(scene.lights.at(0).position));
  expectNearInFloat(position, {4000000.1, 500000.2, 14}, kRounding);
}

// At 30 sizes nothing is gained that is seen.
TEST_F(FarModels, NearerOnesStay) {
  EXPECT_EQ(loadObj("v 40 0 0\nv 41 0 0\nv 40 1 0\nf 1 2 3\n").origin, Vec3d());
  EXPECT_EQ(loadObj("v 50 0 0\nv 51 0 0\nv 50 1 0\nf 1 2 3\n").origin, Vec3d(50.5, 0, 0));
}

}  // namespace
}  // namespace whit
