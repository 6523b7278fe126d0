// OBJ files as they should be, and as other programs write them.
#include <array>
#include <map>

#include "bake/scene.h"
#include "scene_files.h"

namespace whit {
namespace {

using ObjFaces = SceneFileTest;

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Mesh onlyMesh(const SceneDescription& scene) {
  EXPECT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.objects.at(0).meshes.size(), 1u);
  return meshOf(scene);
}

using Vectors = std::vector<Vec3f>;

Vectors cornersOf(const Mesh& mesh) {
  Vectors corners;
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t v : t) corners.push_back(mesh.positions[v]);
  }
  return corners;
}

TEST_F(ObjFaces, EveryFormOfCorner) {
  for (const char* face :
       {"f 1 2 3", "f 1/1 2/2 3/3", "f 1//1 2//1 3//1", "f 1/1/1 2/2/1 3/3/1", "f -4 -3 -2",
        "f -4/-3/-1 -3/-2/-1 -2/-1/-1", "f\t1\t2 \t3 ", "  f 1 2 3  # a comment 4 5"}) {
    const SceneDescription scene =
        loadObj(kSquare + "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n" + face + "\n");
    EXPECT_EQ(cornersOf(onlyMesh(scene)), (Vectors{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}})) << face;
    EXPECT_EQ(kinds(), "") << face;
  }
}

TEST_F(ObjFaces, CornersThatAgreeShareAVertex) {
  const Mesh mesh =
      onlyMesh(loadObj(kSquare + "vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\nf 1/2 3/1 4/1\n"));
  EXPECT_EQ(mesh.triangles.size(), 3u);
  EXPECT_EQ(mesh.positions.size(), 5u);  // four, and the first again with another vt
  EXPECT_EQ(mesh.uvs.size(), 5u);
  EXPECT_TRUE(mesh.normals.empty());
}

TEST_F(ObjFaces, ManyVerticesAtOnePositionStayApart) {
  constexpr int kCount = 5000;
  std::string text = kSquare;
  for (int i = 1; i <= kCount; ++i) {
    text += joined("vt ", i - 1, " 0\nf 1/", i, " 2/", i, " 3/", i, "\n");
  }

  const Mesh mesh = onlyMesh(loadObj(text));
  EXPECT_EQ(mesh.positions.size(), 3u * kCount);

  for (const auto i : indices(mesh.triangles)) {
    for (const std::uint32_t v : mesh.triangles[i]) {
      ASSERT_EQ(mesh.uvs[v].x, static_cast<float>(i));
    }
  }
}

TEST_F(ObjFaces, TextureCoordinatesAndNormalsArriveAtTheirCorners) {
  const Mesh mesh = onlyMesh(loadObj(
      kSquare + "vt 0.25 0.5\nvt -3 7 0\nvt 0.75\nvn 0 0 1\nvn 0 1 0\nf 1/2/1 2/1/2 3/3/1\n"));
  const auto t = mesh.triangles[0];

  EXPECT_EQ(mesh.uvs[t[0]], (Vec2f{-3, 7}));
  EXPECT_EQ(mesh.uvs[t[1]], (Vec2f{0.25f, 0.5f}));
  EXPECT_EQ(mesh.uvs[t[2]], (Vec2f{0.75f, 0}));
  EXPECT_EQ(mesh.normals[t[0]], Vec3f(0, 0, 1));
  EXPECT_EQ(mesh.normals[t[1]], Vec3f(0, 1, 0));
}

// Nothing is said of faces whose material has no texture.
TEST_F(ObjFaces, FacesThatLackTheCoordinatesOfTheirTextureAreCounted) {
  saveImage("a.tga", {"ff0000"});
  save("m.mtl", "newmtl mapped\nmap_Kd a.tga\nnewmtl plain\nKd 1 0 0\n");
  loadObj(std::string("mtllib m.mtl\nvt 0 0\n") + kSquare +
          "f 1 2 3\nusemtl plain\nf 1 2 3\nusemtl mapped\nf 1/1 2/1 3/1\nf 1/1 2/1 4\nf 1 3 4\n");
  expectWarned(
      "face without texture coordinates has the texel at (0, 0) of its material's textures", 2);
}

// A face is turned if all of its corners say so: not if one does not, and not without normals.
TEST_F(ObjFaces, TheNormalsOfCornersDecideWhichSideIsTheFront) {
  const std::string quad = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -1\nvn 0 0 1\n";
  using Triple = std::array<std::uint32_t, 3>;
  const auto windingOf = [&](const char* face) {
    return meshOf(loadObj(quad + face)).triangles.at(0);
  };
  EXPECT_EQ(windingOf("f 1//1 2//1 3//1\n"), (Triple{0, 2, 1}));
  EXPECT_EQ(windingOf("f 1//2 2//2 3//2\n"), (Triple{0, 1, 2}));
  EXPECT_EQ(windingOf("f 1//1 2//1 3//2\n"), (Triple{0, 1, 2}));
  EXPECT_EQ(windingOf("s off\nf 1 2 3\n"), (Triple{0, 1, 2}));
}

TEST_F(ObjFaces, FacesThatLackANormalAreFlat) {
  const SceneDescription scene =
      loadObj(kSquare + "vn 0 0 1\nf 1//1 2//1 3//1\nf 1 3 4\nf 2//1 4 1//1\n");
  const Mesh& mesh = onlyMesh(scene);
  EXPECT_TRUE(mesh.hasFlatFaces);

  ASSERT_EQ(mesh.triangles.size(), 3u);
  for (const auto i : indices(3)) {
    for (const std::uint32_t corner : mesh.triangles[i]) {
      EXPECT_EQ(mesh.normals[corner], i == 0 ? Vec3f(0, 0, 1) : Vec3f()) << i;
    }
  }

  EXPECT_EQ(bake(scene).triangles.size(), 3u);
  expectNoWarnings();
}

// The polygon is an arrowhead. A fan from its first corner would cover the notch.
TEST_F(ObjFaces, PolygonsThatAreNotConvex) {
  const Mesh mesh = onlyMesh(loadObj("v -2 -2 5\nv 0 -1 5\nv 2 -2 5\nv 0 2 5\nf 1 2 3 4\n"));
  EXPECT_EQ(mesh.triangles.size(), 2u);
  for (const auto& t : mesh.triangles) {
    EXPECT_TRUE(std::ranges::count(t, 1u) && std::ranges::count(t, 3u));
  }
}

TEST_F(ObjFaces, LineEndsAndContinuations) {
  const Vectors expected{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};

  // The line ends of Unix, of Windows and of old Macs.
  std::string unix = kSquare + "f 1 2 3", dos, mac;
  for (const char c : unix) {
    if (c == '\n') dos += '\r';
    dos += c;
    mac += c == '\n' ? '\r' : c;
  }

  for (const std::string& text :
       {std::string("v 0 0 0\nv 1 0 0\rv 1 1 0\r\nf 1 2 3"), unix, unix + "\n", dos, dos + "\r\n",
        mac, mac + "\r", kSquare + "f 1 \\\n2 \\\r\n 3\n",
        kSquare + "# C:\\textures\\\nf 1 2 3\n"}) {
    EXPECT_EQ(cornersOf(onlyMesh(loadObj(text))), expected) << text;
  }
}

TEST_F(ObjFaces, MaterialsOfFaces) {
  save("a library.mtl", "newmtl dark red\r\nKd 0.5 0 0\r\n");
  save("sub/second.mtl", "newmtl blue\nKd 0 0 1\nnewmtl dark red\nKd 1 1 1\n");

  const SceneDescription scene = loadObj(
      std::string("mtllib a library.mtl\nmtllib sub\\second.mtl missing.mtl\n") + kSquare +
      "f 1 2 3\nusemtl dark red \nf 1 2 4\nusemtl blue\nf 2 3 4\nusemtl unknown\nf 1 3 4\n");

  const Mesh& mesh = onlyMesh(scene);
  ASSERT_EQ(mesh.triangles.size(), 4u);
  const auto diffuse = [&](std::size_t i) { return scene.materials[mesh.material(i)].diffuse; };

  EXPECT_EQ(diffuse(0), Rgb(0.6f));  // faces without a material are gray
  EXPECT_EQ(diffuse(1), Rgb(0.5f, 0, 0));
  EXPECT_EQ(diffuse(2), Rgb(0, 0, 1));
  EXPECT_EQ(diffuse(3), Rgb(0.6f));

  expectWarned("material library missing");
  expectWarned("material missing, gray instead");
}

TEST_F(ObjFaces, AModelAloneGetsLights) {
  const SceneDescription scene = loadObj(kSquare + "f 1 2 3 4\n");
  EXPECT_EQ(scene.name, "m");
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_GT(scene.lights[0].position.y, 1);
  EXPECT_EQ(scene.lights[0].name, "supplied");
  EXPECT_EQ(scene.lights[1].name, "supplied fill");
}

// Colors follow the position, with a weight in between or not. They are in sRGB: code 188 of 255 is
// 0.502886 in linear light.
TEST_F(ObjFaces, ColorsOfVertices) {
  const SceneDescription scene =
      loadObj("v 0 0 0 1 0 0.737255\nv 1 0 0 1 0 1 0\nv 0 1 0\nf 1 2 3\n");

  const Mesh& mesh = meshOf(scene);
  ASSERT_EQ(mesh.colors.size(), 3u);

  EXPECT_EQ(mesh.colors[0].x, 1);
  EXPECT_NEAR(mesh.colors[0].z, 0.502886f, 1e-5f);
  EXPECT_EQ(mesh.colors[1], Rgb(0, 1, 0));
  EXPECT_EQ(mesh.colors[2], Rgb(1.0f));
  EXPECT_EQ(scene.materials[mesh.materials[0]].diffuse, Rgb(1.0f));

  // Colors may be a little too bright. Values beyond that are codes of 8 bits.
  for (const std::string color : {"1.01 0 0.737255", "255 0 188"}) {
    const SceneDescription other =
        loadObj("v 0 0 0 " + color + "\nv 1 0 0 0 0 0\nv 0 1 0 0 0 0\nf 1 2 3\n");
    EXPECT_NEAR(meshOf(other).colors[0].z, 0.502886f, 1e-5f) << color;
  }
}

TEST_F(ObjFaces, PositionsWithoutZ) {
  const SceneDescription scene = loadObj("v 0 0\nv 1 0\nv 0 1\nf 1 2 3\n");
  EXPECT_EQ(meshOf(scene).positions[1], Vec3f(1, 0, 0));
}

// Two faces meet at a right angle along the z axis. In a smoothing group the normals at this edge
// are the mean by area; elsewhere each face has its own.
TEST_F(ObjFaces, SmoothingGroups) {
  const std::string corners = "v 0 0 0\nv 0 0 -1\nv 1 0 -1\nv 1 0 0\nv 0 1 0\nv 0 1 -1\n";
  const auto normalsAtEdge = [&](const std::string& first, const std::string& second) {
    const Mesh mesh = meshOf(loadObj(corners + first + "f 1 4 3 2\n" + second + "f 1 2 6 5\n"));

    Vectors found;
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t corner : triangle) {
        const bool isAtEdge = mesh.positions[corner] == Vec3f(0, 0, 0);
        if (isAtEdge && !mesh.normals.empty()) found.push_back(mesh.normals[corner]);
      }
    }

    return found;
  };

  const float half = std::sqrt(0.5f);
  const Vectors smooth = normalsAtEdge("s 1\n", "");
  ASSERT_GE(smooth.size(), 2u);
  for (const Vec3f& normal : smooth) EXPECT_LT(length(normal - Vec3f(half, half, 0)), 1e-6f);

  EXPECT_EQ(normalsAtEdge("s off\n", ""), Vectors());
  EXPECT_EQ(normalsAtEdge("s 1\n", "s 0\n").front(), Vec3f(0, 1, 0));
  const Vectors apart = normalsAtEdge("s 1\n", "s 2\n");
  EXPECT_EQ(apart.front(), Vec3f(0, 1, 0));
  EXPECT_EQ(apart.back(), Vec3f(1, 0, 0));
}

}  // namespace
}  // namespace whit
