// Meshes and nodes of glTF files: each way the format has to say where a triangle is.
#include "bake/scene.h"
#include "gltf_files.h"

namespace whit {
namespace {

using GltfGeometry = GltfTest;
using Triangle = std::array<std::uint32_t, 3>;

std::string triangleText(const std::string& nodes) {
  GltfBuilder b;
  return b.json("\"meshes\":[{\"primitives\":[" + triangle(b) + "]}]," + nodes);
}

TEST_F(GltfGeometry, TextBinaryAndExternalBuffersAreTheSame) {
  GltfBuilder b;
  const std::string members = oneMesh(triangle(b));

  std::string external = b.json(members);
  const std::size_t from = external.find("data:"), to = external.find('"', from);
  external.replace(from, to - from, "a%20b.bin");
  save("a b.bin", bytesOf(kTriangleXyz));

  for (const std::string& file :
       {save("t.gltf", b.json(members)), save("t.glb", b.glb(members)), save("e.gltf", external)}) {
    const SceneDescription scene = load(file);
    ASSERT_EQ(triangleCount(scene), 1u) << file;
    for (std::size_t i = 0; i < 3; ++i) {
      expectNear(cornerOf(scene, 0, 0, i),
                 {kTriangleXyz[3 * i], kTriangleXyz[3 * i + 1], kTriangleXyz[3 * i + 2]});
    }
  }
}

TEST_F(GltfGeometry, NodesTransformByScaleRotationTranslationAndParents) {
  // A quarter turn about z takes (2, 0, 0) to (0, 2, 0); the parent adds (0, 0, 5) and doubles.
  const SceneDescription scene = loadText(
      triangleText("\"nodes\":[{\"children\":[1],\"matrix\":[2,0,0,0, 0,2,0,0, 0,0,2,0, 0,0,5,1]},"
                   "{\"mesh\":0,\"translation\":[10,0,0],\"rotation\":[0,0,0.70710678118654757,"
                   "0.70710678118654757],\"scale\":[2,1,1]}],\"scenes\":[{\"nodes\":[0]}]"));

  ASSERT_EQ(scene.instances.size(), 1u);
  expectNear(cornerOf(scene, 0, 0, 0), {20, 0, 5});
  expectNear(cornerOf(scene, 0, 0, 1), {20, 4, 5});
  expectNear(cornerOf(scene, 0, 0, 2), {18, 0, 5});
}

TEST_F(GltfGeometry, NegativeScaleKeepsTheOutside) {
  SceneDescription scene = loadText(triangleText("\"nodes\":[{\"mesh\":0,\"scale\":[-1,1,1]}]"));
  const Scene baked = Scene::finalize(std::move(scene), warnings_);

  ASSERT_EQ(baked.triangles.size(), 1u);
  const float* p = baked.triangles[0].position;
  const Vec3d normal = cross(Vec3d(p[3] - p[0], p[4] - p[1], p[5] - p[2]),
                             Vec3d(p[6] - p[0], p[7] - p[1], p[8] - p[2]));
  expectNear(normal, {0, 0, 1});
}

TEST_F(GltfGeometry, MeshesThatNodesShareBecomeInstances) {
  SceneDescription scene =
      loadText(triangleText("\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"translation\":[5,0,0]}],"
                            "\"scenes\":[{\"nodes\":[0,1]}]"));
  EXPECT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.instances.size(), 2u);
  expectNear(cornerOf(scene, 1, 0, 1), {6, 0, 0});
}

TEST_F(GltfGeometry, OnlyTheDefaultSceneIsShown) {
  const std::string nodes = "\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"translation\":[5,0,0]}]";
  const SceneDescription second =
      loadText(triangleText(nodes + ",\"scenes\":[{\"nodes\":[0]},{\"nodes\":[1]}],\"scene\":1"));
  ASSERT_EQ(second.instances.size(), 1u);
  expectNear(cornerOf(second, 0, 0, 0), {5, 0, 0});
  EXPECT_EQ(loadText(triangleText(nodes)).instances.size(),
            2u);  // without scenes all nodes are shown
}

TEST_F(GltfGeometry, StripsAndFansWindAsSpecified) {
  GltfBuilder b;
  const std::string position = b.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});
  const auto trianglesOf = [&](int mode) {
    const SceneDescription scene =
        loadShown(b, primitive(position, "", ",\"mode\":" + std::to_string(mode)));
    return meshOf(scene).triangles;
  };

  EXPECT_EQ(trianglesOf(5), (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
  EXPECT_EQ(trianglesOf(6), (std::vector<Triangle>{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
}

TEST_F(GltfGeometry, PointsAndLinesAreCounted) {
  GltfBuilder b;
  const std::string points = triangle(b, ",\"mode\":0"), strip = triangle(b, ",\"mode\":3");
  const SceneDescription scene =
      loadShown(b, points + "," + strip + "," + triangle(b, ",\"mode\":4"));
  EXPECT_EQ(triangleCount(scene), 1u);
  EXPECT_EQ(warned("points or lines left out"), 2u);
}

// Indices of every type that they can have lead to the same corners.
TEST_F(GltfGeometry, IndicesOfEveryType) {
  GltfBuilder b;
  const std::string position = b.positions(kTriangleXyz);
  const std::string byType[] = {
      b.accessor(b.view(bytesOf<std::uint8_t>({2, 0, 1})), 5121, "SCALAR", 3),
      b.accessor(b.view(bytesOf<std::uint16_t>({2, 0, 1})), 5123, "SCALAR", 3),
      b.accessor(b.view(bytesOf<std::uint32_t>({2, 0, 1})), 5125, "SCALAR", 3)};

  for (const std::string& indices : byType) {
    const SceneDescription scene = loadShown(b, primitive(position, "", ",\"indices\":" + indices));
    EXPECT_EQ(meshOf(scene).triangles, (std::vector<Triangle>{{2, 0, 1}})) << indices;
  }
}

// Integers stay as they are, or are divided by the largest value of their type if they are
// normalized.
TEST_F(GltfGeometry, PositionsOfEveryType) {
  GltfBuilder b;
  struct Case {
    std::string accessor;
    double one;  // what the components that are set come out as
  };

  const std::string norm = ",\"normalized\":true";
  const auto i8 = b.view(bytesOf<std::int8_t>({0, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0, 0}), 4);
  const auto u8 = b.view(bytesOf<std::uint8_t>({0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 0}), 4);
  const auto i16 = b.view(bytesOf<std::int16_t>({0, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0, 0}), 8);
  const auto u16 = b.view(bytesOf<std::uint16_t>({0, 0, 0, 0, 65535, 0, 0, 0, 0, 65535, 0, 0}), 8);

  const Case cases[] = {
      {b.accessor(i8, 5120, "VEC3", 3), 127},    {b.accessor(i8, 5120, "VEC3", 3, norm), 1},
      {b.accessor(u8, 5121, "VEC3", 3), 255},    {b.accessor(u8, 5121, "VEC3", 3, norm), 1},
      {b.accessor(i16, 5122, "VEC3", 3), 32767}, {b.accessor(i16, 5122, "VEC3", 3, norm), 1},
      {b.accessor(u16, 5123, "VEC3", 3), 65535}, {b.accessor(u16, 5123, "VEC3", 3, norm), 1}};

  for (const Case& c : cases) {
    const SceneDescription scene = loadText(b.json(
        "\"extensionsRequired\":[\"KHR_mesh_quantization\"]," + oneMesh(primitive(c.accessor))));
    expectNear(cornerOf(scene, 0, 0, 1), {c.one, 0, 0});
    expectNear(cornerOf(scene, 0, 0, 2), {0, c.one, 0});
  }
}

TEST_F(GltfGeometry, MostNegativeNormalizedIntegerIsMinusOne) {
  GltfBuilder b;
  const auto view = b.view(bytesOf<std::int8_t>({-128, -127, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}), 4);
  const std::string position = b.accessor(view, 5120, "VEC3", 3, ",\"normalized\":true");
  const SceneDescription scene = loadShown(b, primitive(position));
  expectNear(cornerOf(scene, 0, 0, 0), {-1, -1, 0});
}

TEST_F(GltfGeometry, InterleavedAttributes) {
  GltfBuilder b;
  const int view =
      b.view(bytesOf<float>({0, 0, 0, 0.25f, 0.75f, 1, 0, 0, 0.5f, 1, 0, 1, 0, 0, 0}), 20);
  const std::string position = b.accessor(view, 5126, "VEC3", 3);
  const std::string uv = b.accessor(view, 5126, "VEC2", 3, ",\"byteOffset\":12");

  const SceneDescription scene = loadShown(b, primitive(position, ",\"TEXCOORD_0\":" + uv));
  expectNear(cornerOf(scene, 0, 0, 2), {0, 1, 0});

  // v points down in the file and up in a mesh.
  EXPECT_EQ(meshOf(scene).uvs, (std::vector<Vec2f>{{0.25f, 0.25f}, {0.5f, 0.0f}, {0.0f, 1.0f}}));
}

TEST_F(GltfGeometry, SparseAccessorsReplaceSomeElements) {
  GltfBuilder b;
  const int dense = b.view(bytesOf(kTriangleXyz));
  const int which = b.view(bytesOf<std::uint16_t>({2}));
  const int values = b.view(bytesOf<float>({0, 7, 0}));
  const std::string sparse =
      ",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":" + std::to_string(which) +
      ",\"componentType\":5123},\"values\":{\"bufferView\":" + std::to_string(values) + "}}";

  const std::string replaced = b.accessor(dense, 5126, "VEC3", 3, sparse);
  const std::string onZeros = b.accessor(-1, 5126, "VEC3", 3, sparse);

  const auto corner = [&](const std::string& position, std::size_t i) {
    return cornerOf(loadShown(b, primitive(position)), 0, 0, i);
  };

  expectNear(corner(replaced, 1), {1, 0, 0});
  expectNear(corner(replaced, 2), {0, 7, 0});
  expectNear(corner(onZeros, 1), {0, 0, 0});
  expectNear(corner(onZeros, 2), {0, 7, 0});
}

TEST_F(GltfGeometry, NormalsAreTakenOrFlat) {
  GltfBuilder b;
  const std::string position = b.positions(kTriangleXyz);
  const auto n = b.view(bytesOf<std::int8_t>({0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, 0}), 4);
  const std::string normal = b.accessor(n, 5120, "VEC3", 3, ",\"normalized\":true");

  const SceneDescription with = loadShown(b, primitive(position, ",\"NORMAL\":" + normal));
  expectNear(Vec3d(meshOf(with).normals[1]), {0, 1, 0});

  const SceneDescription without = loadShown(b, primitive(position));
  EXPECT_TRUE(meshOf(without).normals.empty());
}

TEST_F(GltfGeometry, CamerasAndPointLights) {
  const SceneDescription scene = loadText(triangleText(
      "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.5235987755982988,"
      "\"znear\":0.1,\"aspectRatio\":2}},{\"type\":\"orthographic\",\"orthographic\":"
      "{\"xmag\":1,\"ymag\":1.5,\"zfar\":9,\"znear\":1}},{\"type\":\"orthographic\","
      "\"orthographic\":{\"xmag\":1,\"ymag\":0,\"zfar\":9,\"znear\":1}}],"
      "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\",\"name\":\"lamp\","
      "\"intensity\":1366,\"color\":[1,0.5,0],\"range\":9},{\"type\":\"laser\"}]}},"
      "\"nodes\":[{\"mesh\":0},{\"camera\":0,\"name\":\"eye\",\"translation\":[3,0,0],\"rotation\":"
      "[0,0.70710678118654757,0,0.70710678118654757]},{\"camera\":1},{\"camera\":2},"
      "{\"translation\":[1,2,3],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}},"
      "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":1}}}]"));

  ASSERT_EQ(scene.cameras.size(), 2u);
  const Camera& camera = scene.cameras[0];
  EXPECT_EQ(camera.name, "eye");
  EXPECT_EQ(camera.orthographicHeight, 0);
  EXPECT_EQ(scene.cameras[1].orthographicHeight, 3);  // twice ymag
  EXPECT_NEAR(camera.fov, 30, 1e-4);

  // The camera looks along the node's -z, which a quarter turn about +y takes to -x.
  expectNear(normalized(Vec3d(camera.at) - Vec3d(camera.eye)), {-1, 0, 0});
  expectNear(Vec3d(camera.eye), {3, 0, 0});
  EXPECT_EQ(camera.aspect, 2);
  EXPECT_NEAR(scene.cameras[1].aspect, 1 / 1.5, 1e-7);

  EXPECT_EQ(scene.width, 2 * scene.height);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].name, "lamp");
  expectNear(Vec3d(scene.lights[0].position), {1, 2, 3});
  expectNear(Vec3d(scene.lights[0].intensity), {2, 1, 0});  // 1366 cd at 683 lm/W

  EXPECT_EQ(warned("light of an unknown type left out"), 1u);
  EXPECT_EQ(warned("light's range left out, it shines on"), 1u);
  EXPECT_EQ(warned("camera of an unknown type or without an extent left out"), 1u);
}

// Lights shine along the node's -z. Cone angles are in radians from the axis.
TEST_F(GltfGeometry, SpotAndDirectionalLights) {
  const SceneDescription scene = loadText(triangleText(
      "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":["
      "{\"type\":\"spot\",\"intensity\":683,\"spot\":{\"innerConeAngle\":0.5235987755982988,"
      "\"outerConeAngle\":1.0471975511965976}},"
      "{\"type\":\"directional\",\"name\":\"sun\",\"intensity\":1366},"
      "{\"type\":\"spot\",\"spot\":{}},"
      "{\"type\":\"spot\",\"spot\":{\"innerConeAngle\":0.5,\"outerConeAngle\":0.5}},"
      "{\"type\":\"spot\",\"spot\":{\"innerConeAngle\":1,\"outerConeAngle\":0.5}}]}},"
      "\"nodes\":[{\"mesh\":0},"
      "{\"translation\":[1,2,3],\"scale\":[2,2,2],\"rotation\":"
      "[0,0.70710678118654757,0,0.70710678118654757],"
      "\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}},"
      "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":1}}},"
      "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":2}}},"
      "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":3}}},"
      "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":4}}}]"));

  ASSERT_EQ(scene.lights.size(), 5u);
  const Light &spot = scene.lights[0], &sun = scene.lights[1];
  EXPECT_EQ(spot.kind, Light::Kind::spot);
  expectNear(Vec3d(spot.position), {1, 2, 3});
  expectNear(Vec3d(spot.direction), {-1, 0, 0});  // -z turned by 90 degrees about +y
  expectNear(Vec3d(spot.intensity), {1, 1, 1});   // 683 cd at 683 lm/W
  EXPECT_FLOAT_EQ(spot.innerConeAngle, 30);
  EXPECT_FLOAT_EQ(spot.outerConeAngle, 60);

  EXPECT_EQ(sun.kind, Light::Kind::directional);
  EXPECT_EQ(sun.name, "sun");
  expectNear(Vec3d(sun.direction), {0, 0, -1});
  expectNear(Vec3d(sun.intensity), {2, 2, 2});  // 1366 lx

  EXPECT_FLOAT_EQ(scene.lights[2].innerConeAngle, 0);
  EXPECT_FLOAT_EQ(scene.lights[2].outerConeAngle, 45);

  // One cone has a sharp edge, and the other has angles in the wrong order, which are repaired.
  for (const std::size_t i : {3u, 4u}) {
    EXPECT_LT(scene.lights[i].innerConeAngle, scene.lights[i].outerConeAngle);
    EXPECT_NEAR(scene.lights[i].innerConeAngle, scene.lights[i].outerConeAngle, 1e-4);
  }
}

TEST_F(GltfGeometry, FilesWithoutALightAreGivenTwo) {
  const SceneDescription scene = loadText(triangleText("\"nodes\":[{\"mesh\":0}]"));
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[0].name, "supplied");
  EXPECT_EQ(scene.lights[1].name, "supplied fill");
}

TEST_F(GltfGeometry, ScenesPlaceModelsAndOverrideTheirMaterials) {
  GltfBuilder b;
  save("t.glb",
       b.glb("\"materials\":[{\"name\":\"wall\"}]," + oneMesh(triangle(b, ",\"material\":0"))));

  const SceneDescription scene = loadMembers(
      "\"objects\": {\"t\": [{\"model\": \"t.glb\", \"materials\": {\"wall\": {\"diffuse\": "
      "[1,0,0], "
      "\"roughness\": 0.125}}}]}, \"scene\": [{\"use\": \"t\"}, {\"use\": \"t\", \"transform\": "
      "{\"translate\": [0,0,4]}}]");

  ASSERT_EQ(scene.instances.size(), 2u);
  expectNear(cornerOf(scene, 1, 0, 1), {1, 0, 4});
  EXPECT_EQ(scene.materials[0].diffuse, Rgb(1, 0, 0));
  EXPECT_EQ(scene.materials[0].roughness, 0.125f);
  EXPECT_TRUE(scene.lights.empty());
}

}  // namespace
}  // namespace whit
