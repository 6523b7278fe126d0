// Among coplanar opaque faces, the later one of the scene as it was written is seen, also of those
// that objects, groups and models hold. That it does not matter how faces are stored is hard case
// H83b, and oracle/coplanar_test.cpp has faces in random orders.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "io/scene_files.h"
#include "reference/small_scenes.h"
#include "render/data_map.h"
#include "render/pipeline_laws.h"

namespace whit::test {
namespace {

constexpr float kEarly = 0.25f, kLate = 0.75f;

// Expects this radiance in packets and in the reference, straight from above.
void expectOfOrder(const Scene& scene, float wanted, const std::string& what) {
  RenderOptions options;
  options.size = ImageSize{1, 1};
  Scene fromAbove = scene;
  fromAbove.cameras = {
      {.eye = {0, 5, 0}, .at = {0, 0, 0}, .up = {0, 0, -1}, .orthographicHeight = 1}};

  const auto [packets, reference] = renderBoth(fromAbove, options);
  EXPECT_EQ(packets.image.at(0, 0).x, wanted) << what << ", packets";
  EXPECT_EQ(reference.image.at(0, 0).x, wanted) << what << ", reference";
}

// The square lies about the origin, off its center so that no edge passes there.
Mesh squareOfOrder(float half, std::uint32_t material) {
  return quad({-half, 0, half + 0.1f}, {half + 0.3f, 0, half}, {half, 0, -half}, {-half, 0, -half},
              material);
}

// The class of a triangle does not determine its place in the mesh, nor that of its mesh in the
// object.
TEST(SceneOrder, TrianglesOfAMeshComeInTheirOrder) {
  for (const bool twice : {false, true}) {
    SceneBuilder builder;
    Material early = emittingMaterial(kEarly);
    early.castsShadow = false;
    Mesh both = squareOfOrder(2, builder.add(early));
    const Mesh late = squareOfOrder(3, builder.add(emittingMaterial(kLate)));

    both.materials = {0, 0, 1, 1};
    for (const Vec3f& p : late.positions) both.positions.push_back(p);
    both.uvs.clear();
    for (const auto& [a, b, c] : late.triangles) both.triangles.push_back({a + 4, b + 4, c + 4});

    // Another mesh of the object stands before or behind these two squares.
    Mesh apart = squareOfOrder(2.5f, 0);
    for (const bool behind : {false, true}) {
      SceneBuilder one = builder;
      std::vector<Affine> places{Affine()};
      if (twice) places.push_back(Affine::translation({0, 7, 0}) * Affine::scaling(Vec3d(0.01)));

      Object object{"object", {apart, both}};
      if (behind) object.meshes = {both, apart};
      one.place(std::move(object), places);
      expectOfOrder(one.build(), behind ? kEarly : kLate, behind ? "behind" : "before");
    }
  }
}

// Two squares of one material lie in one place. One shows the hole of its mask all over, and the
// other one, before or behind it in the scene, an opaque texel.
TEST(SceneOrder, OneOfTwoIsSeenInTheHolesOfTheOther) {
  for (const bool blends : {false, true}) {
    for (const float last : {0.25f, 0.75f}) {
      SceneBuilder builder;
      Material masked = emittingMaterial(kLate);
      masked.alphaMap = builder.add(dataMap(2, {1, 0}));
      if (blends) {
        masked.coverageMap = masked.alphaMap;
        masked.passClearTexels();
      }

      const std::uint32_t material = builder.add(masked);
      for (const float u : {1 - last, last}) {
        Mesh square = squareOfOrder(2, material);
        square.uvs.assign(4, {u, 0.5f});
        builder.add(std::move(square));
      }
      expectOfOrder(repaired(builder.describe()), kLate, blends ? "blended" : "masked");
    }
  }
}

class SceneOrderOfFiles : public SceneFileTest {
 protected:
  // In `sections`, 'E', 'H' and 'S' stand for dim squares about the origin, which are plain, masked
  // and without a shadow. 'L' stands for a larger, bright one, and AWAY moves what has it aside.
  Scene sceneWith(std::string sections) {
    const auto put = [&](const std::string& name, const std::string& text) {
      for (std::size_t at; (at = sections.find(name)) != std::string::npos;) {
        sections.replace(at, name.size(), text);
      }
    };

    put("'E'", "{'shape': 'quad', 'width': 4, 'depth': 4.3, 'material': 'early'}");
    put("'H'", "{'shape': 'quad', 'width': 4, 'depth': 4.3, 'material': 'holes'}");
    put("'S'", "{'shape': 'quad', 'width': 4, 'depth': 4.3, 'material': 'shadowless'}");
    put("'L'", "{'shape': 'quad', 'width': 6, 'depth': 6.5, 'material': 'late'}");
    put("AWAY", "'transform': {'translate': [30, 0, 0]}");

    save("all.tga", tga({"ffffff"}));
    return Scene::finalize(
        loadMembers("'textures': {'all': {'image': 'all.tga'}}, "
                    "'materials': {'early': {'diffuse': 0, 'emission': 0.25}, "
                    "'holes': {'diffuse': 0, 'emission': 0.25, 'alphaMap': 'all'}, "
                    "'shadowless': {'diffuse': 0, 'emission': 0.25, 'castsShadow': false}, "
                    "'late': {'diffuse': 0, 'emission': 0.75}}, " +
                    sections),
        warnings_);
  }

  void expectSeen(const std::string& sections, float wanted) {
    expectOfOrder(sceneWith(sections), wanted, sections);
  }
};

TEST_F(SceneOrderOfFiles, ItemsComeInTheirOrder) {
  const std::string tile = "'objects': {'tile': ['E']}, ";
  expectSeen("'scene': ['E', 'L']", kLate);
  expectSeen("'scene': ['L', 'E']", kEarly);
  expectSeen("'scene': ['H', 'L']", kLate);
  expectSeen("'scene': ['S', 'L']", kLate);
  expectSeen(tile + "'scene': [{'use': 'tile'}, {'use': 'tile', AWAY}, 'L']", kLate);
  expectSeen(tile + "'scene': [{'use': 'tile', AWAY}, 'L', {'use': 'tile'}]", kEarly);
  expectSeen("'scene': [{'group': ['L', {'group': ['E']}]}, 'L']", kLate);
}

// An object's own shapes keep their order among the objects that it uses, in each of its uses.
TEST_F(SceneOrderOfFiles, WhatAnObjectHoldsComesInItsOrder) {
  for (const std::string scene :
       {"'scene': [{'use': 'both'}]", "'scene': [{'use': 'both', AWAY}, {'use': 'both'}]",
        "'scene': [{'use': 'both', 'repeat': {'count': [1, 1, 3], 'step': [0, 0, 30]}}]"}) {
    const std::string tile = "'objects': {'tile': ['E'], 'both': [";
    expectSeen(tile + "'L', {'group': [{'use': 'tile'}]}]}, " + scene, kEarly);
    expectSeen(tile + "'L', {'use': 'tile'}, 'L']}, " + scene, kLate);
    expectSeen(tile + "{'use': 'tile'}, 'L', {'use': 'tile'}]}, " + scene, kEarly);
  }
}

// Among coincident triangles of one material only the last one is kept, and covers all before it.
TEST_F(SceneOrderOfFiles, WhatIsThereTwiceCountsAsTheLaterOne) {
  expectSeen("'scene': ['E', 'L', 'E']", kEarly);
  expectSeen("'scene': ['L', 'E', 'L']", kLate);
  EXPECT_EQ(warned("triangle in the place of another of its material dropped"), 4u);
}

// The faces of a file keep its order, with normals or without.
TEST_F(SceneOrderOfFiles, FacesOfAModelComeInTheirOrder) {
  const std::string corners =
      "mtllib m.mtl\nv -2 0 2.1\nv 2.2 0 2\nv 2 0 -2\nv -2 0 -2\nvn 0 1 0\n"
      "v -3 0 3.1\nv 3.2 0 3\nv 3 0 -3\nv -3 0 -3\n";
  save("m.mtl",
       "newmtl early\nKd 0 0 0\nKe 0.25 0.25 0.25\nnewmtl late\nKd 0 0 0\nKe 0.75 0.75 0.75\n");

  const std::string flat = "usemtl early\nf 1 2 3 4\n",
                    smooth = "usemtl late\nf 5//1 6//1 7//1 8//1\n";

  for (const char* uses : {"'scene': [{'model': 'm.obj'}]",
                           "'objects': {'m': [{'model': 'm.obj'}]}, "
                           "'scene': [{'use': 'm'}, {'use': 'm', AWAY}]"}) {
    save("m.obj", corners + flat + smooth);
    expectSeen(uses, kLate);

    save("m.obj", corners + smooth + flat);
    expectSeen(uses, kEarly);

    save("m.obj", corners + flat + smooth + flat + "usemtl late\nf 5//1 6//1 7//1 8//1\n");
    expectSeen(uses, kLate);
  }
}

// A node's mesh comes before its children, and the primitives of a mesh keep their order.
TEST_F(SceneOrderOfFiles, NodesOfAModelComeInTheOrderOfTheirTree) {
  const auto gltf = [&](const std::string& nodes) {
    // The buffer holds the corners of two squares and the indices that both share.
    std::vector<float> corners;
    for (const float half : {2.0f, 3.0f}) {
      for (const auto& [x, z] :
           {std::pair{-1.0f, 1.1f}, {1.0f, 1.0f}, {1.0f, -1.1f}, {-1.0f, -1.0f}}) {
        corners.insert(corners.end(), {x * half, 0, z * half});
      }
    }
    save("m.bin", std::string(reinterpret_cast<const char*>(corners.data()), 96) +
                      std::string("\0\0\1\0\2\0\0\0\2\0\3\0", 12));
    save("m.gltf",
         "{'asset': {'version': '2.0'}, 'buffers': [{'uri': 'm.bin', 'byteLength': 108}], "
         "'bufferViews': [{'buffer': 0, 'byteLength': 48}, "
         "{'buffer': 0, 'byteOffset': 48, 'byteLength': 48}, "
         "{'buffer': 0, 'byteOffset': 96, 'byteLength': 12}], "
         "'accessors': [ "
         "{'bufferView': 0, 'componentType': 5126, 'type': 'VEC3', 'count': 4, "
         "'min': [-2, 0, -2.2], 'max': [2, 0, 2.2]}, "
         "{'bufferView': 1, 'componentType': 5126, 'type': 'VEC3', 'count': 4, "
         "'min': [-3, 0, -3.3], 'max': [3, 0, 3.3]}, "
         "{'bufferView': 2, 'componentType': 5123, 'type': 'SCALAR', 'count': 6}], "
         "'materials': [ "
         "{'doubleSided': true, 'emissiveFactor': [0.25, 0.25, 0.25], "
         "'pbrMetallicRoughness': {'baseColorFactor': [0, 0, 0, 1]}}, "
         "{'doubleSided': true, 'emissiveFactor': [0.75, 0.75, 0.75], "
         "'pbrMetallicRoughness': {'baseColorFactor': [0, 0, 0, 1]}}], "
         "'meshes': [ "
         "{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 2, 'material': 0}]}, "
         "{'primitives': [{'attributes': {'POSITION': 1}, 'indices': 2, 'material': 1}]}, "
         "{'primitives': [{'attributes': {'POSITION': 1}, 'indices': 2, 'material': 1}, "
         "{'attributes': {'POSITION': 0}, 'indices': 2, 'material': 0}]}], "
         "'scene': 0, " +
             nodes + "}");
  };

  const std::string sections = "'scene': [{'model': 'm.gltf'}]";
  gltf("'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0, 'children': [1]}, {'mesh': 1}]");
  expectSeen(sections, kLate);

  // The scene lists its root nodes in another order than the file does.
  gltf(
      "'scenes': [{'nodes': [1, 2, 0]}], "
      "'nodes': [{'mesh': 1}, {'mesh': 0}, {'mesh': 0, 'translation': [20, 0, 0]}]");
  expectSeen(sections, kLate);

  gltf(
      "'scenes': [{'nodes': [0, 1, 2]}], "
      "'nodes': [{'mesh': 1}, {'mesh': 0}, {'mesh': 1, 'translation': [20, 0, 0]}]");
  expectSeen(sections, kEarly);

  gltf("'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 2}]");
  expectSeen(sections, kEarly);
}

}  // namespace
}  // namespace whit::test
