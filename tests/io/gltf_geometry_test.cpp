// Meshes and nodes of glTF files: each way the format has to say where a triangle is.
#include "gltf_files.h"
#include "noun_members.h"

namespace whit {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

class GltfGeometry : public GltfTest {
 protected:
  // Loads a file with a triangle as its mesh and these other members.
  SceneDescription loadNodes(const std::string& members) {
    return loadText(json("'meshes':[{'primitives':[" + triangle() + "]}]," + members));
  }

  // Loads a triangle whose positions are this accessor.
  SceneDescription loadAt(const std::string& positions) {
    return loadText(
        json("'extensionsRequired':['KHR_mesh_quantization']," + oneMesh(primitive(positions))));
  }

  static constexpr char kNormalized[] = ",'normalized':true";
};

TEST_F(GltfGeometry, TextBinaryAndExternalBuffersAreTheSame) {
  const std::string members = oneMesh(triangle());

  std::string external = json(members);
  const std::size_t from = external.find("data:"), to = external.find('\'', from);
  external.replace(from, to - from, "a%20b.bin");
  save("a b.bin", bytesOf(kTriangleXyz));

  for (const std::string& file :
       {save("t.gltf", json(members)), save("t.glb", glb(members)), save("e.gltf", external)}) {
    SCOPED_TRACE(file);
    expectTriangle(load(file), kTriangleCorners);
  }
}

TEST_F(GltfGeometry, NodesTransformByScaleRotationTranslationAndParents) {
  // A quarter turn about z takes (2, 0, 0) to (0, 2, 0); the parent adds (0, 0, 5) and doubles.
  const SceneDescription scene = loadNodes(
      "'nodes':[{'children':[1],'matrix':[2,0,0,0, 0,2,0,0, 0,0,2,0, "
      "0,0,5,1]},{'mesh':0,'translation':[10,0,0],'rotation':[0,0,0.70710678118654757,0."
      "70710678118654757],'scale':[2,1,1]}],'scenes':[{'nodes':[0]}]");

  ASSERT_EQ(scene.instances.size(), 1u);
  expectTriangle(scene, {{20, 0, 5}, {20, 4, 5}, {18, 0, 5}});
}

TEST_F(GltfGeometry, NegativeScaleKeepsTheOutside) {
  const Scene baked = bake(loadNodes("'nodes':[{'mesh':0,'scale':[-1,1,1]}]"));

  ASSERT_EQ(baked.triangles.size(), 1u);
  const float* p = baked.triangles[0].position;
  const Vec3d normal = cross(Vec3d(p[3] - p[0], p[4] - p[1], p[5] - p[2]),
                             Vec3d(p[6] - p[0], p[7] - p[1], p[8] - p[2]));
  expectNearInFloat(normal, {0, 0, 1});
}

// Nodes that share a mesh are instances of one object. Without scenes all nodes are shown.
TEST_F(GltfGeometry, OnlyTheDefaultSceneIsShown) {
  const std::string nodes = "'nodes':[{'mesh':0},{'mesh':0,'translation':[5,0,0]}]";
  for (const char* scenes : {"", ",'scenes':[{'nodes':[0,1]}]"}) {
    const SceneDescription both = loadNodes(nodes + scenes);
    EXPECT_EQ(both.objects.size(), 1u);
    ASSERT_EQ(both.instances.size(), 2u);
    expectNearInFloat(cornerOf(both, 1, 1), {6, 0, 0});
  }

  const SceneDescription second =
      loadNodes(nodes + ",'scenes':[{'nodes':[0]},{'nodes':[1]}],'scene':1");
  ASSERT_EQ(second.instances.size(), 1u);
  expectNearInFloat(cornerOf(second, 0), {5, 0, 0});
}

TEST_F(GltfGeometry, StripsAndFansWindAsSpecified) {
  const std::string position = positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});
  const auto trianglesOf = [&](const std::string& mode) {
    return meshOf(loadShown(primitive(position, "", ",'mode':" + mode))).triangles;
  };

  EXPECT_EQ(trianglesOf("5"), (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
  EXPECT_EQ(trianglesOf("6"), (std::vector<Triangle>{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
}

// Indices of every type that they can have lead to the same corners.
TEST_F(GltfGeometry, IndicesOfEveryType) {
  const std::string position = positions(kTriangleXyz);
  for (const std::string& indices :
       {add<std::uint8_t>("SCALAR", {2, 0, 1}), add<std::uint16_t>("SCALAR", {2, 0, 1}),
        add<std::uint32_t>("SCALAR", {2, 0, 1})}) {
    EXPECT_EQ(meshOf(loadShown(primitive(position, "", ",'indices':" + indices))).triangles,
              (std::vector<Triangle>{{2, 0, 1}}))
        << indices;
  }
}

// Integers stay as they are, or are divided by the largest value of their type if they are
// normalized.
TEST_F(GltfGeometry, PositionsOfEveryType) {
  const auto expectOne = [&]<typename T>(T largest) {
    const std::vector<T> values{0, 0, 0, 0, largest, 0, 0, 0, 0, largest, 0, 0};
    for (const bool isNormalized : {false, true}) {
      const double one = isNormalized ? 1 : largest;
      const std::string position =
          add("VEC3", values, 4 * sizeof(T), isNormalized ? kNormalized : "");
      expectTriangle(loadAt(position), {{0, 0, 0}, {one, 0, 0}, {0, one, 0}});
    }
  };
  expectOne(std::int8_t{127});
  expectOne(std::uint8_t{255});
  expectOne(std::int16_t{32767});
  expectOne(std::uint16_t{65535});
}

TEST_F(GltfGeometry, MostNegativeNormalizedIntegerIsMinusOne) {
  const std::vector<std::int8_t> values{-128, -127, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0};
  expectNearInFloat(cornerOf(loadAt(add("VEC3", values, 4, kNormalized)), 0), {-1, -1, 0});
}

TEST_F(GltfGeometry, InterleavedAttributes) {
  const int both =
      view(bytesOf<float>({0, 0, 0, 0.25f, 0.75f, 1, 0, 0, 0.5f, 1, 0, 1, 0, 0, 0}), 20);
  const std::string position = accessor(both, 5126, "VEC3", 3);
  const std::string uv = accessor(both, 5126, "VEC2", 3, ",'byteOffset':12");

  const SceneDescription scene = loadShown(primitive(position, ",'TEXCOORD_0':" + uv));
  expectNearInFloat(cornerOf(scene, 2), {0, 1, 0});

  // v points down in the file and up in a mesh.
  EXPECT_EQ(meshOf(scene).uvs, (std::vector<Vec2f>{{0.25f, 0.25f}, {0.5f, 0.0f}, {0.0f, 1.0f}}));
}

TEST_F(GltfGeometry, SparseAccessorsReplaceSomeElements) {
  const std::string some = sparse<float>({2}, {0, 7, 0});
  const std::string onTriangle = add("VEC3", kTriangleXyz, 0, some);
  const std::string onZeros = accessor(-1, 5126, "VEC3", 3, some);
  expectTriangle(loadShown(primitive(onTriangle)), {{0, 0, 0}, {1, 0, 0}, {0, 7, 0}});
  expectTriangle(loadShown(primitive(onZeros)), {{0, 0, 0}, {0, 0, 0}, {0, 7, 0}});
}

TEST_F(GltfGeometry, NormalsAreTakenOrFlat) {
  const std::vector<std::int8_t> up{0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, 0};
  const std::string normal = ",'NORMAL':" + add("VEC3", up, 4, kNormalized);
  const std::string position = positions(kTriangleXyz);

  expectNearInFloat(meshOf(loadShown(primitive(position, normal))).normals[1], {0, 1, 0});
  EXPECT_TRUE(meshOf(loadShown(primitive(position))).normals.empty());
}

TEST_F(GltfGeometry, CamerasAndPointLights) {
  const SceneDescription scene = loadNodes(
      "'cameras':[{'type':'perspective','perspective':{'yfov':0.5235987755982988,'znear':0.1,'"
      "aspectRatio':2}},{'type':'orthographic','orthographic':{'xmag':1,'ymag':1.5,'zfar':9,'znear'"
      ":1}},{'type':'orthographic','orthographic':{'xmag':1,'ymag':0,'zfar':9,'znear':1}}],'"
      "extensions':{'KHR_lights_punctual':{'lights':[{'type':'point','name':'lamp','intensity':"
      "1366,'color':[1,0.5,0],'range':9},{'type':'laser'}]}},'nodes':[{'mesh':0},{'camera':0,'name'"
      ":'eye','translation':[3,0,0],'rotation':[0,0.70710678118654757,0,0.70710678118654757]},{'"
      "camera':1},{'camera':2},{'translation':[1,2,3],'extensions':{'KHR_lights_punctual':{'light':"
      "0}}},{'extensions':{'KHR_lights_punctual':{'light':1}}}]");

  ASSERT_EQ(scene.cameras.size(), 2u);
  const Camera& camera = scene.cameras[0];
  EXPECT_EQ(camera.name, "eye");
  expectMembers(camera, "{'fov': 30, 'aspect': 2, 'orthographicHeight': 0, 'eye': [3,0,0]}");
  // The camera looks along the node's -z, which a quarter turn about +y takes to -x.
  expectNearInFloat(normalized(Vec3d(camera.at) - Vec3d(camera.eye)), {-1, 0, 0});
  expectMembers(scene.cameras[1], "{'orthographicHeight': 3, 'aspect': 0.66666667}");  // twice ymag
  EXPECT_EQ(scene.width, 2 * scene.height);

  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].name, "lamp");
  // 1366 cd at 683 lm/W
  expectMembers(scene.lights[0], "{'position': [1,2,3], 'intensity': [2,1,0]}");

  expectWarned("light of an unknown type left out");
  expectWarned("light's range left out, it shines on");
  expectWarned("camera of an unknown type or without an extent left out");
}

// Lights shine along the node's -z. Cone angles are in radians from the axis.
TEST_F(GltfGeometry, SpotAndDirectionalLights) {
  const SceneDescription scene = loadNodes(
      "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'spot','intensity':683,'spot':{'"
      "innerConeAngle':0.5235987755982988,'outerConeAngle':1.0471975511965976}},{'type':'"
      "directional','name':'sun','intensity':1366},{'type':'spot','spot':{}},{'type':'spot','spot':"
      "{'innerConeAngle':0.5,'outerConeAngle':0.5}},{'type':'spot','spot':{'innerConeAngle':1,'"
      "outerConeAngle':0.5}}]}},'nodes':[{'mesh':0},{'translation':[1,2,3],'scale':[2,2,2],'"
      "rotation':[0,0.70710678118654757,0,0.70710678118654757],'extensions':{'KHR_lights_punctual':"
      "{'light':0}}},{'extensions':{'KHR_lights_punctual':{'light':1}}},{'extensions':{'KHR_lights_"
      "punctual':{'light':2}}},{'extensions':{'KHR_lights_punctual':{'light':3}}},{'extensions':{'"
      "KHR_lights_punctual':{'light':4}}}]");

  ASSERT_EQ(scene.lights.size(), 5u);
  // The first is turned by 90 degrees about +y; 683 cd at 683 lm/W.
  expectMembers(scene.lights[0],
                "{'type': 'spot', 'position': [1,2,3], 'direction': [-1,0,0], 'intensity': 1, "
                "'innerConeAngle': 30, 'outerConeAngle': 60}");
  EXPECT_EQ(scene.lights[1].name, "sun");
  // 1366 lx
  expectMembers(scene.lights[1], "{'type': 'directional', 'direction': [0,0,-1], 'irradiance': 2}");
  expectMembers(scene.lights[2], "{'innerConeAngle': 0, 'outerConeAngle': 45}");

  // One cone has a sharp edge, and the other has angles in the wrong order, which are repaired.
  for (const Light& light : {scene.lights[3], scene.lights[4]}) {
    EXPECT_LT(light.innerConeAngle, light.outerConeAngle);
    EXPECT_NEAR(light.innerConeAngle, light.outerConeAngle, 1e-4);
  }
}

TEST_F(GltfGeometry, ScenesPlaceModelsAndOverrideTheirMaterials) {
  save("t.glb", glb("'materials':[{'name':'wall'}]," + oneMesh(triangle(",'material':0"))));

  const SceneDescription scene = loadMembers(
      "'objects': {'t': [{'model': 't.glb', 'materials': {'wall': {'diffuse': [1,0,0], "
      "'roughness': 0.125}}}]}, 'scene': [{'use': 't'}, {'use': 't', 'transform': {'translate': "
      "[0,0,4]}}]");

  ASSERT_EQ(scene.instances.size(), 2u);
  expectNearInFloat(cornerOf(scene, 1, 1), {1, 0, 4});
  EXPECT_EQ(scene.materials[0].diffuse, Rgb(1, 0, 0));
  EXPECT_EQ(scene.materials[0].roughness, 0.125f);
  EXPECT_TRUE(scene.lights.empty());
}

// Each copy of a node that is moved by (0, 0, 5) has these attributes.
class GltfInstancing : public GltfGeometry {
 protected:
  SceneDescription loadCopies(const std::string& attributes) {
    return loadNodes(
        "'extensionsRequired':['EXT_mesh_gpu_instancing'],'nodes':[{'mesh':0,'translation':[0,0,5],"
        "'extensions':{'EXT_mesh_gpu_instancing':{'attributes':{" +
        attributes + "}}}}]");
  }
};

TEST_F(GltfInstancing, CopiesStandWhereTheAttributesSay) {
  const float half = std::sqrt(0.5f);  // a quarter turn about z
  const std::string rotation = floats("VEC4", {0, 0, half, half, 0, 0, 0, 1});
  const SceneDescription scene =
      loadCopies("'TRANSLATION':" + positions({1, 2, 3, -1, 0, 0}) + ",'ROTATION':" + rotation +
                 ",'SCALE':" + positions({2, 2, 2, 1, 1, 1}));

  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.objects.size(), 1u);

  // Scale, rotation, translation of the copy and translation of the node apply in this order.
  expectNearInFloat(cornerOf(scene, 0), {1, 2, 8});
  expectNearInFloat(cornerOf(scene, 1), {1, 4, 8});
  expectNearInFloat(cornerOf(scene, 1, 1), {0, 0, 5});
  expectNoWarnings();
}

TEST_F(GltfInstancing, AttributesMustFitTogether) {
  const std::string two = positions({1, 2, 3, -1, 0, 0}), one = positions({1, 1, 1});
  EXPECT_EQ(errorOf([&] { loadCopies("'TRANSLATION':" + two + ",'SCALE':" + one); }),
            "3 m.gltf#/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes: expected attributes "
            "of equal lengths, found 1 beside 2");

  // A scale of 0 makes a copy flat.
  EXPECT_EQ(triangleCount(loadCopies("'SCALE':" + positions({1, 0, 1, 1, 1, 1}))), 1u);
  expectWarned("copy of a mesh that is flattened left out");
}

}  // namespace
}  // namespace whit
