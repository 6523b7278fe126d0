// OBJ files that are wrong: repaired and counted, or refused with the line.

#include "bake/scene.h"
#include "scene_files.h"

namespace whit {
namespace {

using ObjHostile = SceneFileTest;

TEST_F(ObjHostile, WhatIsLeftOutIsCountedWithItsFirstLine) {
  expectRead(
      "m.obj",
      {
          // Vertex indices out of range drop the face, and others are ignored.
          {kTriangleObj +
               "f 1 2 4\nf 0 1 2\nf -4 -2 -1\nf 1 2 99999999999999\nf -2147483648 1 2\nf a b c\n",
           "1; face with a vertex index out of range dropped (6 from m.obj:5)"},
          {"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n\nf 1/9/1 2/1/1 3/1/1\n"
           "f 1//7 2//1 3//1\nf 1/-5 2/1 3/1\n",
           "3; normal index out of range ignored (1 from m.obj:8); texture coordinate index out of "
           "range ignored (2 from m.obj:7)"},
          {kTriangleObj + "f 1\nf 1 2\nf \nl 1 2\np 1\n",
           "1; face with fewer than three corners dropped (2 from m.obj:5); points, lines or free "
           "forms left out (2 from m.obj:8)"},

          // A face comes after its vertices. Lines are counted across continuations.
          {"f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n",
           "0; face with a vertex index out of range dropped (1 from m.obj:1); model with nothing "
           "to draw: no face that can be built (1 from m.obj)"},
          {"v 0 0 0\nv 1 \\\n0 \\\n0\nv 0 1 0\nf 1 \\\n2 9\n",
           "0; face with a vertex index out of range dropped (1 from m.obj:6); model with nothing "
           "to draw: no face that can be built (1 from m.obj)"},
          {"v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\n",
           "0; model with nothing to draw: no faces (1 from m.obj); points, lines or free forms "
           "left out (1 from m.obj:4)"},

          // Nothing and nonsense are empty models.
          {"", "0; model with nothing to draw: no faces (1 from m.obj)"},
          {"\n\n", "0; model with nothing to draw: no faces (1 from m.obj)"},
          {"hello\nworld \\", "0; model with nothing to draw: no faces (1 from m.obj)"},
          {std::string(5000, '\\'), "0; model with nothing to draw: no faces (1 from m.obj)"},
          {"f\nf \ng\no\ns\nusemtl\nmtllib\nt 1\n",
           "0; model with nothing to draw: no faces (1 from m.obj)"},
      });
}

TEST_F(ObjHostile, MissingNumbersAreErrorsWithTheirLine) {
  expectErrorsOf(
      "m.obj", {
                   {"v 0 0 0\n\nv 1 2 z\n", "3 m.obj:3: expected three numbers after \"v\""},
                   {"v 0 zero 0\n", "3 m.obj:1: expected three numbers after \"v\""},
                   {"v 0 \\\n0 0\nvn 1 0x2 3\n", "3 m.obj:3: expected three numbers after \"vn\""},
                   {"vt\n", "3 m.obj:1: expected numbers after \"vt\""},
               });
}

TEST_F(ObjHostile, WhatIsNotFiniteStaysSo) {
  for (const char* odd : {"nan", "-inf", "1e999", "NaN(7)"}) {
    const SceneDescription scene = loadObj(kTriangleObj + "v 5 " + odd + " 5\nf 2 3 4\n");
    const Mesh& mesh = meshOf(scene);
    EXPECT_FALSE(isFinite(mesh.positions[mesh.triangles.at(1)[2]])) << odd;

    // The triangle of this position is dropped with a warning.
    Warnings warnings;
    EXPECT_EQ(Scene::finalize(SceneDescription(scene), warnings).triangles.size(), 1u) << odd;
    EXPECT_FALSE(warnings.entries().empty()) << odd;
  }

  EXPECT_EQ(triangleCount(loadObj("v 1e-3 +2.5E+2 -.5\nv 1 0 0\nv 0 1 0 # last\nf 1 2 3\n")), 1u);
}

TEST_F(ObjHostile, StrictRefusesWhatWouldBeMended) {
  EXPECT_EQ(errorIfStrict(save("m.obj", kTriangleObj + "f 1 2 4\n")),
            "3 m.obj:5: face with a vertex index out of range dropped (refused by --strict)");
  EXPECT_EQ(errorIfStrict(save("m.obj", "v 0 0 0\n")),
            "3 m.obj: model with nothing to draw: no faces (refused by --strict)");
}

TEST_F(ObjHostile, MemoryIsCheckedBeforeItIsTaken) {
  std::string text = kTriangleObj;
  for (int i = 0; i < 500; ++i) text += "f 1 2 3\n";
  for (const std::uint64_t bytes : {20000, 100}) {
    options_.maxMemoryBytes = bytes;
    expectErrorsOf("m.obj", {{text, "5 m.obj *"}});
  }
}

// Each of many bad faces names its line. To count lines from the top for each of them would take
// minutes.
TEST_F(ObjHostile, EveryFaceMayBeBad) {
  std::string text = kTriangleObj;
  for (int i = 0; i < 300'000; ++i) text += "f 1 2 9\n";
  expectRead("m.obj",
             {{text, "1; face with a vertex index out of range dropped (300000 from m.obj:5)"}});
}

TEST_F(ObjHostile, MaterialsHaveALimit) {
  std::string uses = kTriangleObj, library;
  for (int i = 0; i <= 65536; ++i) {
    uses += joined("usemtl ", i, "\n");
    library += joined("newmtl ", i, "\n");
  }

  EXPECT_EQ(errorOfObj(uses), "5 m.obj uses more than 65536 materials");
  save("m.mtl", library);
  EXPECT_EQ(errorOfObj("mtllib m.mtl\n"), "5 m.mtl:65537: more than 65536 materials");
}

}  // namespace
}  // namespace whit
