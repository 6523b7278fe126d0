// Models that the library assimp reads, in a process of its own. Each of
// tests/fuzz/corpus/*/tetra.* holds the tetrahedron that expectTetrahedron() describes.
#include "io/assimp/assimp_model.h"

#include <array>
#include <cstring>

#include "core/display.h"
#include "gltf_files.h"
#include "noun_members.h"
#include "sanitized.h"
#include "solids.h"

namespace whit {
namespace {

class Assimp : public GltfTest {
 protected:
  void SetUp() override {
    if (convertByAssimp("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", 1 << 30)
            .glb.empty()) {
      GTEST_SKIP() << "built without libassimp";
    }
  }

  SceneDescription loadBytes(const std::string& extension, const std::string& bytes) {
    return load(save("m." + extension, bytes));
  }
  static std::string tetra(const std::string& extension) {
    return corpusFile(extension + "/tetra." + extension);
  }
  SceneDescription loadTetra(const std::string& extension) {
    return loadBytes(extension, tetra(extension));
  }
};

struct PlacedTriangle {
  std::array<Vec3d, 3> corners, normals;
  std::array<Rgb, 3> colors;

  bool operator==(const PlacedTriangle&) const = default;
};

std::vector<PlacedTriangle> trianglesOf(const SceneDescription& scene) {
  std::vector<PlacedTriangle> all;
  for (const Instance& instance : scene.instances) {
    for (const Mesh& mesh : scene.objects[instance.object].meshes) {
      for (const auto& t : mesh.triangles) {
        PlacedTriangle& placed = all.emplace_back();
        for (const auto k : indices(3)) {
          placed.corners[k] = instance.toWorld.point(Vec3d(mesh.positions.at(t[k])));
          placed.normals[k] = normalized(instance.toWorld.vector(Vec3d(mesh.normals.at(t[k]))));
          if (!mesh.colors.empty()) placed.colors[k] = mesh.colors.at(t[k]);
        }
      }
    }
  }

  return all;
}

Vec3d faceNormal(const PlacedTriangle& t) {
  return normalized(cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]));
}

// Expects the corners (0, 0, 0), (1, 0, 0), (0, 2, 0) and (0, 0, 3), moved by `lift` along the
// file's z axis, and 4 faces that look out, with hard edges. `turned` means that the file has z up
// and that the model was turned to have y up.
void expectTetrahedron(const SceneDescription& scene, double lift, bool turned) {
  const std::vector<PlacedTriangle> triangles = trianglesOf(scene);
  ASSERT_EQ(triangles.size(), 4u);
  const auto placed = [&](const Vec3d& p) {
    return turned ? Vec3d{p.x, p.z + lift, -p.y} : p + Vec3d{0, 0, lift};
  };
  const std::array corners{placed({0, 0, 0}), placed({1, 0, 0}), placed({0, 2, 0}),
                           placed({0, 0, 3})};
  const Vec3d middle = (corners[0] + corners[1] + corners[2] + corners[3]) / 4.0;

  // The middle of the body is behind every face that looks out.
  for (const PlacedTriangle& t : triangles) {
    EXPECT_GT(dot(faceNormal(t), t.corners[0] - middle), 0);
    for (const auto k : indices(3)) {
      expectNearInFloat(t.normals[k], faceNormal(t), 1e-5);
      const auto near = [&](const Vec3d& p) { return length(p - t.corners[k]) < 1e-5; };
      EXPECT_TRUE(std::ranges::any_of(corners, near));
    }
  }
}

TEST_F(Assimp, StlStandsWithZUp) {
  expectTetrahedron(loadTetra("stl"), 0, true);
  expectNoWarnings();
  options_.settings = {"/up='y'"};
  expectTetrahedron(loadTetra("stl"), 0, false);
}

TEST_F(Assimp, TextOfStlIsReadAsWell) {
  const SceneDescription scene = loadBytes("stl", corpusFile("stl/box.stl"));
  const std::vector<PlacedTriangle> triangles = trianglesOf(scene);
  EXPECT_EQ(triangles.size(), 12u);
  for (const PlacedTriangle& t : triangles) expectNearInFloat(t.normals[0], faceNormal(t), 1e-6);
  EXPECT_EQ(scene.materials.at(0).diffuse, Rgb(0.6f)) << "as other models without materials";
  expectNoWarnings();
}

// They are from 0 to 1, or codes up to 255: 188 is 0.502886 in linear light.
TEST_F(Assimp, ColorsOfOff) {
  for (const std::string color : {"0.737255 0 1 1", "188 0 255 255"}) {
    std::string text = "COFF\n3 1 0\n";
    for (const std::string corner : {"0 0 0 ", "1 0 0 ", "0 1 0 "}) text += corner + color + "\n";
    const Rgb read = trianglesOf(loadBytes("off", text + "3 0 1 2\n")).at(0).colors[0];
    expectNearInFloat(read, {0.502886, 0, 1}, 1e-5);
  }
}

// The library crashes where a mesh has no vertices.
TEST_F(Assimp, EmptySolidsOfStlAreLeftOut) {
  const std::string solid = corpusFile("stl/box.stl"), empty = "solid none\nendsolid none\n";
  EXPECT_EQ(trianglesOf(loadBytes("stl", solid + empty)).size(), 12u);
  expectErrorsOf("m.stl", {{empty, "*it has no faces"}});
}

// Bits 0 to 4 are blue, then green and red: codes of 5 bits on a screen.
TEST_F(Assimp, ColorBitsOfStl) {
  const SceneDescription scene = loadTetra("stl");
  const std::vector<PlacedTriangle> triangles = trianglesOf(scene);
  ASSERT_EQ(triangles.size(), 4u);

  const Rgb gray(static_cast<float>(srgbToLinear(16 / 31.0)));
  const Rgb colors[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, gray};
  for (std::size_t i = 0; i < 4; ++i) {
    for (const Rgb& color : triangles[i].colors) {
      expectNearInFloat(color, Vec3d(colors[i]), 1e-6);
    }
  }

  // The colors of faces replace the material's.
  EXPECT_EQ(scene.materials.at(0).diffuse, Rgb(1.0f));
}

// Neighboring sides of a prism of 24 corners differ by 15 degrees, and its ends differ from them by
// 90.
TEST_F(Assimp, NormalsAreSmoothedBelowAnAngle) {
  options_.settings = {"/up='y'"};
  const SceneDescription scene = loadBytes("off", "OFF\n48 26 0\n" + linesOf(prism(24, 2)));

  int sides = 0;
  for (const PlacedTriangle& t : trianglesOf(scene)) {
    const bool isSide = std::abs(faceNormal(t).z) < 0.5;
    sides += isSide;
    for (std::size_t k = 0; k < 3; ++k) {
      // Sides are smoothed into each other; the top and the bottom keep their own normal.
      const Vec3d radial{t.corners[k].x, t.corners[k].y, 0};
      expectNearInFloat(t.normals[k], isSide ? radial : faceNormal(t), 1e-5);
    }
  }

  EXPECT_EQ(sides, 48);
}

TEST_F(Assimp, OffColladaFbxAnd3ds) {
  options_.settings = {"/up='z'"};
  expectTetrahedron(loadTetra("off"), 0, true);

  options_.settings = {};
  // The Collada and FBX files themselves say that z is up.
  save("t.png", corpusFile("png/rgb.png"));
  expectTetrahedron(loadTetra("dae"), 5, true);
  expectTetrahedron(loadTetra("fbx"), 5, true);

  // Programs also write the other axes of the file's coordinate system.
  std::string allAxes = tetra("fbx");
  allAxes.insert(allAxes.find("\t\tP: \"UpAxisSign\""),
                 "\t\tP: \"FrontAxis\", \"int\", \"Integer\", \"\", 1\n\t\tP: \"FrontAxisSign\", "
                 "\"int\", \"Integer\", \"\", -1\n\t\tP: \"CoordAxis\", \"int\", \"Integer\", "
                 "\"\", 0\n\t\tP: \"CoordAxisSign\", \"int\", \"Integer\", \"\", 1\n");
  expectTetrahedron(loadBytes("fbx", allAxes), 5, true);
  expectNoWarnings();

  std::string text = tetra("3ds");
  std::memcpy(text.data() + text.find("T.PNG"), "t.png", 5);
  expectTetrahedron(loadBytes("3ds", text), 0, true);
  expectNoWarnings();

  // A Collada file says which axis is up, so that /up is refused for it.
  options_.settings = {"/up='x'"};
  expectErrorsOf("m.dae", {{tetra("dae"), "*/up*"}});
}

// The picture beside the model is its base color, which replaces the color of the file. Files of
// 3ds Max have a third texture coordinate.
TEST_F(Assimp, TexturesLieBesideTheModel) {
  save("t.png", corpusFile("png/rgb.png"));
  std::string three =
      replaced(tetra("dae"), "8\">0 0 1 0 0 1 1 1<", "12\">0 0 9 1 0 9 0 1 9 1 1 9<");
  three = replaced(three, "stride=\"2\"", "stride=\"3\"");
  three = replaced(three, "<param name=\"T\" type=\"float\"/>",
                   "<param name=\"T\" type=\"float\"/><param name=\"P\" type=\"float\"/>");

  for (const auto& [extension, text] :
       {std::pair{"dae", tetra("dae")}, {"dae", three}, {"fbx", tetra("fbx")}}) {
    const SceneDescription scene = loadBytes(extension, text);

    const Material& material = scene.materials.at(0);
    EXPECT_EQ(material.name, "red");
    EXPECT_NE(material.diffuseMap, kNoTexture) << extension;
    expectMembers(material, "{'diffuse': 1, 'doubleSided': true, 'mirror': 0}");

    const Mesh& mesh = scene.objects[scene.instances[0].object].meshes[0];
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const Vec3f& p = mesh.positions[i];
      const Vec2f expected = p.z > 0 ? Vec2f{1, 1} : Vec2f{p.x, p.y / 2};
      EXPECT_EQ(mesh.uvs.at(i), expected) << extension << " v points up";
    }
  }
}

// The library calls the material of meshes without one "DefaultMaterial".
TEST_F(Assimp, MaterialsOfAnyNameKeepTheirColor) {
  const std::string fbx = replaced(tetra("fbx"), "\tC: \"OP\",4,3, \"DiffuseColor\"\n", "");
  const std::string dae = replaced(tetra("dae"), "<texture texture=\"p\" texcoord=\"UV\"/>",
                                   "<color>0.8 0.1 0.1 1</color>");

  const SceneDescription scenes[] = {
      loadBytes("fbx", replaced(fbx, "Material::red", "Material::")),
      loadBytes("fbx", replaced(fbx, "Material::red", "Material::DefaultMaterial")),
      loadBytes("dae", replaced(dae, "name=\"red\"", "name=\"DefaultMaterial\""))};
  for (const SceneDescription& scene : scenes) {
    expectMembers(scene.materials.at(0), "{'diffuse': [0.8, 0.1, 0.1]}");
  }

  // The mesh has no material. Of Collada the library does not survive such a file everywhere.
  const SceneDescription bare = loadBytes("fbx", replaced(fbx, "\tC: \"OO\",3,2\n", ""));
  EXPECT_EQ(bare.materials.at(0).name, kNoMaterialName);
  expectMembers(bare.materials.at(0), "{'diffuse': 0.6}");
}

TEST_F(Assimp, ConstantSurfacesOfColladaEmitAndDoNothingElse) {
  save("t.png", corpusFile("png/rgb.png"));
  const std::string text =
      replaced(replaced(tetra("dae"), "<lambert>", "<constant>"), "</lambert>", "</constant>");
  const std::string black = "{'diffuse': 0, 'specular': 0, 'mirror': 0, 'mirrorGrazing': 0, ";

  const std::string map = "<diffuse><texture texture=\"p\" texcoord=\"UV\"/></diffuse>";
  const SceneDescription plain =
      loadBytes("dae", replaced(text, map, "<emission><color>0.5 0.7 0.1 1</color></emission>"));
  expectMembers(plain.materials.at(0), black + "'emission': [0.5, 0.7, 0.1]}");

  const std::string emission =
      replaced(replaced(map, "<diffuse>", "<emission>"), "</diffuse>", "</emission>");
  const Material mapped = loadBytes("dae", replaced(text, map, emission)).materials.at(0);
  expectMembers(mapped, black + "'emission': 1}");
  EXPECT_NE(mapped.emissionMap, kNoTexture);
}

TEST_F(Assimp, NoFileOutsideOfTheFolderIsRead) {
  save("../secret.png", corpusFile("png/rgb.png"));
  const std::string text = replaced(tetra("dae"), "<init_from>t.png", "<init_from>../secret.png");
  const SceneDescription scene = loadBytes("dae", text);

  // A texture of one texel stands in for it.
  const std::uint32_t map = scene.materials.at(0).diffuseMap;
  ASSERT_NE(map, kNoTexture);
  EXPECT_EQ(scene.textures.at(map).texels.size(), 1u);
  EXPECT_NE(kinds(), "");
}

// Gives the mesh a controller with a joint that is turned. If the joint were applied, the mesh
// would be elsewhere.
TEST_F(Assimp, ARiggedModelIsShownAtRest) {
  std::string text = tetra("dae");
  text = replaced(
      text, "<library_visual_scenes>",
      "<library_controllers><controller id='c'><skin source='#g'><source id='j'><Name_array "
      "id='ja' count='1'>bone</Name_array><technique_common><accessor source='#ja' "
      "count='1'><param name='JOINT' type='Name'/></accessor></technique_common></source><source "
      "id='b'><float_array id='ba' count='16'>1 0 0 9 0 1 0 0 0 0 1 0 0 0 0 "
      "1</float_array><technique_common><accessor source='#ba' count='1' stride='16'><param "
      "type='float4x4'/></accessor></technique_common></source><source id='w'><float_array id='wa' "
      "count='1'>1</float_array><technique_common><accessor source='#wa' count='1'><param "
      "name='WEIGHT' type='float'/></accessor></technique_common></source><joints><input "
      "semantic='JOINT' source='#j'/><input semantic='INV_BIND_MATRIX' "
      "source='#b'/></joints><vertex_weights count='4'><input semantic='JOINT' source='#j' "
      "offset='0'/><input semantic='WEIGHT' source='#w' offset='1'/><vcount>1 1 1 1</vcount><v>0 0 "
      "0 0 0 0 0 "
      "0</v></vertex_weights></skin></controller></library_controllers><library_visual_scenes>");

  // The node shows the mesh by the controller, and another node is its joint.
  text = replaced(text, "<instance_geometry url=\"#g\">",
                  "<instance_controller url=\"#c\"><skeleton>#bone</skeleton>");
  text = replaced(text, "</instance_geometry>", "</instance_controller>");
  text = replaced(text, "<node id=\"n\"",
                  "<node id='bone' sid='bone' name='bone' type='JOINT'><rotate>0 0 1 "
                  "90</rotate></node><node id=\"n\"");

  save("t.png", corpusFile("png/rgb.png"));
  expectTetrahedron(loadBytes("dae", text), 5, true);
  expectLike(kinds(), "*shown at rest*");
}

// A binary STL file of triangles, each of nine coordinates.
std::string stlOf(const std::vector<std::vector<float>>& triangles) {
  std::string file = std::string(80, ' ') + word(triangles.size());
  for (const std::vector<float>& corners : triangles) {
    file += std::string(12, '\0') + bytesOf(corners) + std::string(2, '\0');
  }
  return file;
}

// The unit square in the plane z = 0, as two triangles, and perhaps a third one.
std::string squareStl(const std::vector<float>& third = {}) {
  std::vector<std::vector<float>> triangles{{0, 0, 0, 1, 0, 0, 1, 1, 0},
                                            {0, 0, 0, 1, 1, 0, 0, 1, 0}};
  if (!third.empty()) triangles.push_back(third);
  return stlOf(triangles);
}

constexpr char kBadFace[] = "face with a corner that is not finite or not there left out";

TEST_F(Assimp, FacesWithCornersThatAreNotFiniteAreLeftOut) {
  const auto expected = trianglesOf(loadBytes("stl", squareStl()));
  ASSERT_EQ(expected.size(), 2u);

  std::uint64_t count = 0;
  for (const std::vector<float>& third :
       {std::vector<float>{0, 0, 1, 1, 0, 1, NAN, 0, 0}, {0, 0, 1, 1, 0, 1, 0, 1, INFINITY}}) {
    const std::string file = squareStl(third);
    EXPECT_EQ(trianglesOf(loadBytes("stl", file)), expected);
    expectWarned(kBadFace, ++count);
    expectLike(errorIfStrict(save("m.stl", file)), joined("*", kBadFace, "*"));
  }
}

TEST_F(Assimp, WhatIsLeftOutOfOffFilesIsCounted) {
  const std::string vertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  expectRead("m.off",
             {
                 // The first quadrilateral has a corner that is beyond the range of floats.
                 {"OFF\n6 2 0\n" + vertices + "2 0 1e39\n2 1 0\n4 1 4 5 2\n4 0 1 2 3\n",
                  joined("2; ", kBadFace, " (1 from *")},
                 {"OFF\n4 1 0\n" + vertices + "4 0 1 2 7\n",
                  "2; vertex index out of range replaced by the last vertex (1 from *"},
                 // Colors of vertices are read, and a comment is no color.
                 {"OFF\n4 2 0\n" + vertices + "3 0 1 2 # 9\n3 0 2 3\n", "2"},
                 {"OFF 4 2 0\n" + vertices + "3 0 1 2\n\n3 0 2 3 255 0 0\n",
                  "2; colors of faces left out (1 from *"},
             });
}

// STL files have normals beside corners, OFF files have not.
TEST_F(Assimp, AFileOfBadFacesAloneShowsNothing) {
  const std::string stl = stlOf({2, {NAN, 0, 0, 1, 0, 0, 0, 1, 0}});
  const std::pair<const char*, std::string> files[] = {
      {"stl", stl}, {"off", "OFF\n3 1 0\nnan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"}};
  for (const auto& [kind, file] : files) {
    const std::string error = errorOf(
        [&, k = kind, f = file] { EXPECT_TRUE(trianglesOf(loadBytes(k, f)).empty()) << k; });
    if (error != "no error") expectLike(error, "*it has no faces*");
  }
}

TEST_F(Assimp, BadFilesEndWithAnError) {
  expectErrorsOf(
      "m.stl",
      {{"", "3 m.stl: expected a model that the library assimp can read, but it is empty"}});
  expectLike(errorOfFile(root_ + "none.fbx"), "4 *");

  // A small file has 512 MB. Sanitizers end a process without memory in their own way.
  expectErrorsOf("m.off", {{"OFF\n0 0 0\n", "3 m.off: expected a model*"},
                           {"OFF\n60000000 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
                            kSanitized ? "*expected a model*" : "*it needs more memory*"}});

  // A count of 2,000,000,000 vertices needs more memory than is allowed.
  options_.maxMemoryBytes = 256u << 20;
  EXPECT_NE(errorOf([&] { loadBytes("off", "OFF\n2000000000 1 0\n0 0 0\n3 0 0 0\n"); }),
            "no error");
}

}  // namespace
}  // namespace whit
