// Among coplanar opaque faces, the later one of the scene as it was written is seen, however the
// faces are stored: baked or instanced, masked or not, casting shadows or not.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "io/scene_files.h"
#include "reference/small_scenes.h"
#include "render/pipeline_laws.h"

namespace whit::test {
namespace {

constexpr float kEarly = 0.25f, kLate = 0.75f;

// For packets and the reference, the first row of pixels of a view straight from above, along x.
using SeenOfOrder = std::array<std::vector<float>, 2>;

SeenOfOrder seenOf(const Scene& scene, int width = 1) {
  RenderOptions options;
  options.size = ImageSize{width, 1};
  Camera camera;
  camera.eye = {0, 5, 0};
  camera.at = {0, 0, 0};
  camera.up = {0, 0, -1};
  camera.orthographicHeight = 1;

  Renderer renderer(scene, options);
  SeenOfOrder seen;
  for (const bool reference : {false, true}) {
    Film film = makeFilm(scene, options);
    if (reference) {
      renderer.renderReference(camera, film);
    } else {
      renderer.render(camera, film);
    }
    for (const Rgb& pixel : film.image.pixels) seen[reference].push_back(pixel.x);
  }
  return seen;
}

void expectOfOrder(const SeenOfOrder& seen, const std::vector<float>& wanted,
                   const std::string& what) {
  EXPECT_EQ(seen[0], wanted) << what << ", packets";
  EXPECT_EQ(seen[1], wanted) << what << ", reference";
}

enum class Stored { inTheWorld, withItsLikeElsewhere, shadowless, withHoles, shadowlessWithHoles };
constexpr Stored kStored[] = {Stored::inTheWorld, Stored::withItsLikeElsewhere, Stored::shadowless,
                              Stored::withHoles, Stored::shadowlessWithHoles};

// The square lies about the origin, off its center so that no edge passes there.
Mesh squareOfOrder(float half, std::uint32_t material) {
  return quad({-half, 0, half + 0.1f}, {half + 0.3f, 0, half}, {half, 0, -half}, {-half, 0, -half},
              material);
}

void placeAs(Stored stored, float half, float radiance, SceneBuilder& builder) {
  Material material = emittingMaterial(radiance);
  const bool shadowless = stored == Stored::shadowless || stored == Stored::shadowlessWithHoles;
  material.castsShadow = !shadowless;
  if (stored == Stored::withHoles || stored == Stored::shadowlessWithHoles) {
    material.alphaMap = builder.add(makeTexture(TexelFormat::data, 1, 1, {0xffffffffu}));
  }

  std::vector<Affine> places{Affine()};
  if (stored == Stored::withItsLikeElsewhere) places.push_back(Affine::translation({20, 0, 0}));
  builder.place({"object", {squareOfOrder(half, builder.add(material))}}, places);
}

TEST(SceneOrder, TheLaterIsSeenHoweverBothAreStored) {
  for (const Stored early : kStored) {
    for (const Stored late : kStored) {
      SceneBuilder builder;
      placeAs(early, 2, kEarly, builder);
      placeAs(late, 3, kLate, builder);
      const std::string what = "stored as " + std::to_string(static_cast<int>(early)) + " and " +
                               std::to_string(static_cast<int>(late));
      expectOfOrder(seenOf(builder.build()), {kLate}, what);
    }
  }
}

// A floor covers the first use of an object and is covered by the second.
TEST(SceneOrder, EachUseOfAnObjectHasAPlaceOfItsOwn) {
  SceneBuilder builder;
  const auto tile = builder.add(emittingMaterial(kLate)),
             floor = builder.add(emittingMaterial(kEarly));

  builder.place({"tile", {squareOfOrder(0.3f, tile)}}, {Affine::translation({-1, 0, 0})});
  builder.place({"floor", {squareOfOrder(5, floor)}}, {Affine()});
  builder.description.instances.push_back({0, Affine::translation({1, 0, 0})});
  expectOfOrder(seenOf(builder.build(), 3), {kEarly, kEarly, kLate}, "two uses");
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
      const float wanted = behind ? kEarly : kLate;
      expectOfOrder(seenOf(one.build()), {wanted}, behind ? "behind" : "before");
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

    put("'E'", R"({"shape": "quad", "width": 4, "depth": 4.3, "material": "early"})");
    put("'H'", R"({"shape": "quad", "width": 4, "depth": 4.3, "material": "holes"})");
    put("'S'", R"({"shape": "quad", "width": 4, "depth": 4.3, "material": "shadowless"})");
    put("'L'", R"({"shape": "quad", "width": 6, "depth": 6.5, "material": "late"})");
    put("AWAY", R"("transform": {"translate": [30, 0, 0]})");

    save("all.tga", tga(1, 1, {{255, 255, 255}}));
    return Scene::finalize(loadMembers(R"("textures": {"all": {"image": "all.tga"}},
                       "materials": {"early": {"diffuse": 0, "emission": 0.25},
                                     "holes": {"diffuse": 0, "emission": 0.25, "alphaMap": "all"},
                                     "shadowless": {"diffuse": 0, "emission": 0.25,
                                                    "castsShadow": false},
                                     "late": {"diffuse": 0, "emission": 0.75}}, )" +
                                       sections),
                           warnings_);
  }

  void expectSeen(const std::string& sections, float wanted) {
    expectOfOrder(seenOf(sceneWith(sections)), {wanted}, sections);
  }
};

TEST_F(SceneOrderOfFiles, ItemsComeInTheirOrder) {
  const std::string tile = R"("objects": {"tile": ['E']}, )";
  expectSeen(R"("scene": ['E', 'L'])", kLate);
  expectSeen(R"("scene": ['L', 'E'])", kEarly);
  expectSeen(R"("scene": ['H', 'L'])", kLate);
  expectSeen(R"("scene": ['S', 'L'])", kLate);
  expectSeen(tile + R"("scene": [{"use": "tile"}, 'L'])", kLate);
  expectSeen(tile + R"("scene": [{"use": "tile"}, {"use": "tile", AWAY}, 'L'])", kLate);
  expectSeen(tile + R"("scene": [{"use": "tile", AWAY}, 'L', {"use": "tile"}])", kEarly);
  expectSeen(R"("scene": [{"group": ['L', {"group": ['E']}]}, 'L'])", kLate);
}

// An object's own shapes keep their order among the objects that it uses, in each of its uses.
TEST_F(SceneOrderOfFiles, WhatAnObjectHoldsComesInItsOrder) {
  const std::string uses[] = {R"("scene": [{"use": "both"}])",
                              R"("scene": [{"use": "both"}, {"use": "both", AWAY}])",
                              R"("scene": [{"use": "both", AWAY}, {"use": "both"}])",
                              R"("scene": [{"use": "both", "repeat":
                                            {"count": [1, 1, 3], "step": [0, 0, 30]}}])"};
  for (const std::string& scene : uses) {
    for (const std::string one : {R"({"use": "tile"})", R"({"group": [{"use": "tile"}]})"}) {
      const std::string tile = R"("objects": {"tile": ['E'], "both": [)";
      expectSeen(tile + one + ", 'L']}, " + scene, kLate);
      expectSeen(tile + "'L', " + one + "]}, " + scene, kEarly);
      expectSeen(tile + "'L', " + one + ", 'L']}, " + scene, kLate);
      expectSeen(tile + one + ", 'L', " + one + "]}, " + scene, kEarly);
    }
  }
}

// There are three levels of objects, each used twice or more, and later items of the scene.
TEST_F(SceneOrderOfFiles, ObjectsWithinObjectsComeWhereTheyAreUsed) {
  const std::string objects = R"("objects": {
    "inner": ['L'],
    "middle": [{"use": "inner"}, 'E'],
    "outer": ['L', {"use": "middle"}, {"group": [{"use": "inner", AWAY}]}]}, )";

  const std::string far = R"({"use": "outer", AWAY})", near = R"({"use": "outer"})";
  expectSeen(objects + R"("scene": [)" + far + ", " + near + "]", kEarly);
  expectSeen(objects + R"("scene": [)" + near + ", " + far + "]", kEarly);
  expectSeen(objects + R"("scene": [)" + near + ", 'L', " + far + "]", kLate);
  expectSeen(objects + R"("scene": [)" + far + ", 'L', " + near + "]", kEarly);
  expectSeen(objects + R"("scene": [)" + far + ", " + near + R"(, {"use": "middle", AWAY}, 'L'])",
             kLate);
}

// Among coincident triangles of one material only the last one is kept, and covers all before it.
TEST_F(SceneOrderOfFiles, WhatIsThereTwiceCountsAsTheLaterOne) {
  expectSeen(R"("scene": ['E', 'L', 'E'])", kEarly);
  expectSeen(R"("scene": ['L', 'E', 'L'])", kLate);
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

  for (const char* uses : {R"("scene": [{"model": "m.obj"}])",
                           R"("objects": {"m": [{"model": "m.obj"}]},
                              "scene": [{"use": "m"}, {"use": "m", AWAY}])"}) {
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
    std::string buffer;
    for (const float half : {2.0f, 3.0f}) {
      for (const auto& [x, z] :
           {std::pair{-1.0f, 1.1f}, {1.0f, 1.0f}, {1.0f, -1.1f}, {-1.0f, -1.0f}}) {
        for (const float c : {x * half, 0.0f, z * half}) {
          buffer.append(reinterpret_cast<const char*>(&c), sizeof c);
        }
      }
    }

    for (const std::uint16_t i : std::array<std::uint16_t, 6>{0, 1, 2, 0, 2, 3}) {
      buffer.append(reinterpret_cast<const char*>(&i), sizeof i);
    }

    save("m.bin", buffer);
    save(
        "m.gltf", R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "m.bin", "byteLength": 108}],
      "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 48},
                      {"buffer": 0, "byteOffset": 96, "byteLength": 12}],
      "accessors": [
        {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4,
         "min": [-2, 0, -2.2], "max": [2, 0, 2.2]},
        {"bufferView": 1, "componentType": 5126, "type": "VEC3", "count": 4,
         "min": [-3, 0, -3.3], "max": [3, 0, 3.3]},
        {"bufferView": 2, "componentType": 5123, "type": "SCALAR", "count": 6}],
      "materials": [
        {"doubleSided": true, "emissiveFactor": [0.25, 0.25, 0.25],
         "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}},
        {"doubleSided": true, "emissiveFactor": [0.75, 0.75, 0.75],
         "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}}],
      "meshes": [
        {"primitives": [{"attributes": {"POSITION": 0}, "indices": 2, "material": 0}]},
        {"primitives": [{"attributes": {"POSITION": 1}, "indices": 2, "material": 1}]},
        {"primitives": [{"attributes": {"POSITION": 1}, "indices": 2, "material": 1},
                        {"attributes": {"POSITION": 0}, "indices": 2, "material": 0}]}],
      "scene": 0, )" + nodes +
                      "}");
  };

  const std::string sections = R"("scene": [{"model": "m.gltf"}])";
  gltf(R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "children": [1]}, {"mesh": 1}])");
  expectSeen(sections, kLate);

  // The scene lists its root nodes in another order than the file does.
  gltf(R"("scenes": [{"nodes": [1, 2, 0]}],
          "nodes": [{"mesh": 1}, {"mesh": 0}, {"mesh": 0, "translation": [20, 0, 0]}])");
  expectSeen(sections, kLate);

  gltf(R"("scenes": [{"nodes": [0, 1, 2]}],
          "nodes": [{"mesh": 1}, {"mesh": 0}, {"mesh": 1, "translation": [20, 0, 0]}])");
  expectSeen(sections, kEarly);

  gltf(R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 2}])");
  expectSeen(sections, kEarly);
}

}  // namespace
}  // namespace whit::test
