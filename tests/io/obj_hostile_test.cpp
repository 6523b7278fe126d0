// OBJ files that are wrong: repaired and counted, or refused with the line.
#include <cmath>

#include "bake/scene.h"
#include "scene_files.h"

namespace whit {
namespace {

class ObjHostile : public SceneFileTest {
 protected:
  std::string placeOf(const std::string& kind) {
    const auto entries = warnings_.entries();
    const auto entry = entries.find(kind);
    return entry == entries.end() ? "" : entry->second.first.substr(root_.size());
  }
};

TEST_F(ObjHostile, VertexIndicesOutOfRangeDropTheFace) {
  const SceneDescription scene =
      loadObj(std::string(kTriangleObj) +
              "f 1 2 4\nf 0 1 2\nf -4 -2 -1\nf 1 2 99999999999999\nf -2147483648 1 2\nf a b c\n");
  EXPECT_EQ(triangleCount(scene), 1u);
  EXPECT_EQ(warned("face with a vertex index out of range dropped"), 6u);
  EXPECT_EQ(placeOf("face with a vertex index out of range dropped"), "m.obj:5");
}

TEST_F(ObjHostile, FacesBeforeTheirVerticesAreDropped) {
  EXPECT_EQ(triangleCount(loadObj("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n")), 0u);
  EXPECT_EQ(warned("face with a vertex index out of range dropped"), 1u);
}

TEST_F(ObjHostile, OtherIndicesOutOfRangeAreIgnored) {
  const SceneDescription scene = loadObj(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n\nf 1/9/1 2/1/1 3/1/1\nf 1//7 2//1 "
      "3//1\nf 1/-5 2/1 3/1\n");

  EXPECT_EQ(triangleCount(scene), 3u);
  EXPECT_EQ(warned("texture coordinate index out of range ignored"), 2u);
  EXPECT_EQ(placeOf("texture coordinate index out of range ignored"), "m.obj:7");
  EXPECT_EQ(warned("normal index out of range ignored"), 1u);
}

TEST_F(ObjHostile, FacesWithFewCornersAreDropped) {
  EXPECT_EQ(triangleCount(loadObj(std::string(kTriangleObj) + "f 1\nf 1 2\nf \nl 1 2\np 1\n")), 1u);
  EXPECT_EQ(warned("face with fewer than three corners dropped"), 2u);
}

TEST_F(ObjHostile, LinesAreCountedAcrossContinuations) {
  loadObj("v 0 0 0\nv 1 \\\n0 \\\n0\nv 0 1 0\nf 1 \\\n2 9\n");
  EXPECT_EQ(placeOf("face with a vertex index out of range dropped"), "m.obj:6");
}

TEST_F(ObjHostile, MissingNumbersAreErrorsWithTheirLine) {
  EXPECT_EQ(errorOfObj("v 0 0 0\n\nv 1 2 z\n"), "3 m.obj:3: expected three numbers after \"v\"");
  EXPECT_EQ(errorOfObj("v 0 zero 0\n"), "3 m.obj:1: expected three numbers after \"v\"");
  EXPECT_EQ(errorOfObj("v 0 \\\n0 0\nvn 1 0x2 3\n"),
            "3 m.obj:3: expected three numbers after \"vn\"");
  EXPECT_EQ(errorOfObj("vt\n"), "3 m.obj:1: expected numbers after \"vt\"");
}

TEST_F(ObjHostile, WhatIsNotFiniteStaysSo) {
  for (const char* odd : {"nan", "-inf", "1e999", "NaN(7)"}) {
    const SceneDescription scene =
        loadObj(std::string(kTriangleObj) + "v 5 " + odd + " 5\nf 2 3 4\n");
    const Mesh& mesh = meshOf(scene);
    EXPECT_FALSE(isFinite(mesh.positions[mesh.triangles.at(1)[2]])) << odd;

    // The triangle of this position is dropped with a warning.
    Warnings warnings;
    SceneDescription copy = scene;
    EXPECT_EQ(Scene::finalize(std::move(copy), warnings).triangles.size(), 1u) << odd;
    EXPECT_FALSE(warnings.entries().empty()) << odd;
  }

  EXPECT_EQ(triangleCount(loadObj("v 1e-3 +2.5E+2 -.5\nv 1 0 0\nv 0 1 0 # last\nf 1 2 3\n")), 1u);
}

TEST_F(ObjHostile, StrictRefusesWhatWouldBeMended) {
  const std::string file = save("m.obj", std::string(kTriangleObj) + "f 1 2 4\n");
  EXPECT_EQ(errorIfStrict(file),
            "3 m.obj:5: face with a vertex index out of range dropped (refused by --strict)");
}

TEST_F(ObjHostile, NothingAndNonsenseAreEmptyModels) {
  for (const std::string& text :
       {std::string(), std::string("\n\n"), std::string("hello\nworld \\"), std::string(5000, '\\'),
        std::string("f\nf \ng\no\ns\nusemtl\nmtllib\nt 1\n")}) {
    const SceneDescription scene = loadObj(text);
    EXPECT_EQ(triangleCount(scene), 0u);
  }
}

TEST_F(ObjHostile, WhatIsNotShownIsCounted) {
  loadObj(std::string(kTriangleObj) + "l 1 2\np 3\n");
  EXPECT_EQ(warned("points, lines or free forms left out"), 2u);
  EXPECT_EQ(placeOf("points, lines or free forms left out"), "m.obj:5");
}

TEST_F(ObjHostile, NothingToDrawIsSaidWithItsReason) {
  loadObj("v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\n");
  EXPECT_EQ(warned("model with nothing to draw: no faces"), 1u);
  loadObj("v 0 0 0\nf 1 1 9\n");
  EXPECT_EQ(warned("model with nothing to draw: no face that can be built"), 1u);

  const std::string file = save("m.obj", "v 0 0 0\n");
  EXPECT_EQ(errorIfStrict(file),
            "3 m.obj: model with nothing to draw: no faces (refused by --strict)");
}

TEST_F(ObjHostile, MemoryIsCheckedBeforeItIsTaken) {
  options_.maxMemoryBytes = 20000;
  std::string text = kTriangleObj;
  for (int i = 0; i < 500; ++i) text += "f 1 2 3\n";
  EXPECT_EQ(errorOfObj(text).substr(0, 8), "5 m.obj ");
  options_.maxMemoryBytes = 100;
  EXPECT_EQ(errorOfObj(text).substr(0, 8), "5 m.obj ");
}

// Each of many bad faces names its line. To count lines from the top for each of them would take
// minutes.
TEST_F(ObjHostile, EveryFaceMayBeBad) {
  constexpr std::uint64_t kFaces = 300'000;
  std::string text = kTriangleObj;
  for (std::uint64_t i = 0; i < kFaces; ++i) text += "f 1 2 9\n";
  EXPECT_EQ(triangleCount(loadObj(text)), 1u);
  EXPECT_EQ(warned("face with a vertex index out of range dropped"), kFaces);
}

TEST_F(ObjHostile, MaterialsHaveALimit) {
  std::string uses = kTriangleObj, library;
  for (int i = 0; i <= 65536; ++i) {
    uses += "usemtl " + std::to_string(i) + "\n";
    library += "newmtl " + std::to_string(i) + "\n";
  }

  EXPECT_EQ(errorOfObj(uses), "5 m.obj uses more than 65536 materials");
  save("m.mtl", library);
  EXPECT_EQ(errorOfObj("mtllib m.mtl\n"), "5 m.mtl:65537: more than 65536 materials");
}

}  // namespace
}  // namespace whit
