// PLY files: the same model in every form that the format has, and files that are wrong.
#include "scene/description.h"
#include "scene_files.h"

namespace whit {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

class Ply : public SceneFileTest {
 protected:
  SceneDescription loadPly(const std::string& text) { return load(save("m.ply", text)); }

  static std::string header(const std::string& format, const std::string& rest) {
    return "ply\nformat " + format + " 1.0\ncomment made by hand\n" + rest + "end_header\n";
  }
  static std::string ascii(const std::string& rest) { return header("ascii", rest); }

  // Returns the header of a unit square, with an element in between that is unknown to readers.
  static std::string squareHeader(const std::string& format) {
    return header(
        format,
        "element vertex 4\nproperty float x\nproperty double y\nproperty short z\nproperty uchar "
        "red\nelement oddity 1\nproperty list uchar int things\nproperty float rest\nelement face "
        "1\nproperty uchar flags\nproperty list uchar int vertex_indices\n");
  }

  static std::string binarySquare(bool little) {
    std::string text = squareHeader(little ? "binary_little_endian" : "binary_big_endian");
    const auto put = [&](auto value) {
      std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
      if (!little) std::ranges::reverse(bytes);
      text += bytes;
    };

    for (const auto& [x, y] : {std::pair{0.0f, 0.0}, {1.0f, 0.0}, {1.0f, 1.0}, {0.0f, 1.0}}) {
      put(x);
      put(y);
      put(std::int16_t{-300});
      text += '\xff';
    }

    // The unknown element, whose bytes are skipped by its declaration.
    text += '\2';
    put(7);
    put(8);
    put(1.5f);

    text += "\x9\4";
    for (int i = 0; i < 4; ++i) put(i);
    return text;
  }
};

constexpr char kTriangleHeader[] =
    "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar uint vertex_index\n";

constexpr char kTriangle[] = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

TEST_F(Ply, TextAndBytesOfEitherOrderAreTheSame) {
  const std::string text =
      squareHeader("ascii") +
      "0 0 -300 255\n1 0 -300 255\n1 1 -300 255\n0 1 -300 255\n2 7 8 1.5\n9 4 0 1 2 3\n";

  for (const std::string& file : {text, binarySquare(true), binarySquare(false)}) {
    const SceneDescription scene = loadPly(file);
    ASSERT_EQ(triangleCount(scene), 2u);
    EXPECT_EQ(scene.origin, Vec3d(0, 0, -300));
    EXPECT_EQ(meshOf(scene).positions,
              (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  }

  expectWarned("vertex colors that lack a channel left out", 3);
  expectWarned("elements of a kind that is not shown", 3);
}

// Integers are sRGB codes, scaled by the largest of their type; floats are linear.
TEST_F(Ply, ColorsOfVertices) {
  struct Codes {
    std::string properties, first;  // of the first vertex
  };
  for (const auto& [properties, first] :
       {Codes{"property uchar red\nproperty uchar green\nproperty uchar blue\n", "255 0 188"},
        {"property ushort red\nproperty ushort green\nproperty ushort blue\n", "65535 0 48316"},
        {"property float red\nproperty float green\nproperty float blue\n", "1 0 0.502886"},
        {"property float r\nproperty float g\nproperty float b\n", "1 0 0.502886"}}) {
    SCOPED_TRACE(properties);
    const SceneDescription scene =
        loadPly(ascii("element vertex 3\nproperty float x\nproperty float y\nproperty float z\n" +
                      properties + "element face 1\nproperty list uchar uint vertex_index\n") +
                "0 0 0 " + first + "\n1 0 0 0 0 0\n0 1 0 0 0 0\n3 0 1 2\n");

    const Mesh& mesh = meshOf(scene);
    ASSERT_EQ(mesh.colors.size(), 3u);
    EXPECT_EQ(mesh.colors[0].x, 1);
    EXPECT_EQ(mesh.colors[0].y, 0);
    EXPECT_NEAR(mesh.colors[0].z, 0.502886f, 1e-5f);
    EXPECT_EQ(scene.materials[mesh.materials[0]].diffuse, Rgb(1.0f));
  }
}

TEST_F(Ply, NormalsAndTextureCoordinates) {
  const Mesh mesh = meshOf(
      loadPly(ascii("element vertex 3\nproperty float nx\nproperty float ny\nproperty float nz\n"
                    "property float x\nproperty float y\nproperty float z\nproperty float s\n"
                    "property float t\nelement face 1\nproperty list uchar int vertex_indices\n") +
              "0 0 1 0 0 0 0.5 0.25\n0 0 1 1 0 0 1 0\n0 0 1 +0 1e0 0 0 1\n3 0 1 2\n"));

  EXPECT_EQ(mesh.normals[2], Vec3f(0, 0, 1));
  EXPECT_EQ(mesh.uvs[0], (Vec2f{0.5f, 0.25f}));
  EXPECT_EQ(mesh.positions[2], Vec3f(0, 1, 0));
}

TEST_F(Ply, NormalsDecideWhichSideIsTheFront) {
  const std::string head = ascii(
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n"
      "property list uchar int vertex_indices\n");
  const std::string vertices = "0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n";
  for (const std::string face : {"3 0 2 1\n", "3 0 1 2\n"}) {
    EXPECT_EQ(meshOf(loadPly(head + vertices + face)).triangles[0], (Triangle{0, 1, 2})) << face;
  }
}

TEST_F(Ply, PolygonsThatAreNotConvex) {
  // The polygon is an arrowhead. A fan from its first corner would cover the notch.
  const SceneDescription scene =
      loadPly(ascii("element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                    "element face 1\nproperty list uchar int vertex_indices\n") +
              "-2 -2 0\n0 -1 0\n2 -2 0\n0 2 0\n4 0 1 2 3\n");

  EXPECT_EQ(meshOf(scene).triangles.size(), 2u);
  for (const Triangle& t : meshOf(scene).triangles) {
    EXPECT_TRUE(std::ranges::count(t, 1u) && std::ranges::count(t, 3u));
  }
}

// The strip is 0 1 2 3, whose last corner is repeated. After -1 another strip begins.
TEST_F(Ply, StripsAndTheirRestarts) {
  const std::string vertices =
      "element vertex 5\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n";
  const std::vector<Triangle> expected = {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}};

  const SceneDescription scene =
      loadPly(ascii(vertices + strips) + points + "9 0 1 2 3 3 -1 2 3 4\n");

  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(meshOf(scene).triangles, expected);
  expectNoWarnings();

  // An index out of range ends the strip.
  EXPECT_EQ(triangleCount(loadPly(ascii(vertices + strips) + points + "5 0 1 2 7 3\n")), 1u);
  expectWarned("rest of a strip behind a vertex index out of range dropped");
}

// A number too large for a double is infinite. It must not become 0, which is a valid position.
TEST_F(Ply, NumbersBeyondDoubleAreInfinite) {
  const Mesh mesh =
      meshOf(loadPly(ascii(kTriangleHeader) + "0 0 1e-999\n1e999 0 0\n0 -1e999 0\n3 0 1 2\n"));
  EXPECT_EQ(mesh.positions[0].z, 0);
  EXPECT_EQ(mesh.positions[1].x, INFINITY);
  EXPECT_EQ(mesh.positions[2].y, -INFINITY);
}

constexpr char kFourVertices[] =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
constexpr char kTwoFaces[] = "element face 2\nproperty list uchar int vertex_indices\n";
constexpr char kCorners[] = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

// Two faces share two vertices but have different colors there. Code 188 is 0.502886 in linear
// light.
TEST_F(Ply, ColorsOfFaces) {
  const std::string colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const SceneDescription scene = loadPly(ascii(kFourVertices + (kTwoFaces + colors)) + kCorners +
                                         "3 0 1 2 255 0 188\n3 0 2 3 0 255 0\n");

  const Mesh& mesh = meshOf(scene);
  ASSERT_EQ(mesh.triangles.size(), 2u);

  for (const std::uint32_t corner : mesh.triangles[0]) {
    EXPECT_EQ(mesh.colors[corner].x, 1);
    EXPECT_NEAR(mesh.colors[corner].z, 0.502886f, 1e-5f);
  }
  for (const std::uint32_t corner : mesh.triangles[1]) {
    EXPECT_EQ(mesh.colors[corner], Rgb(0, 1, 0));
  }

  EXPECT_EQ(mesh.positions[mesh.triangles[1][2]], Vec3f(0, 1, 0));
  EXPECT_EQ(scene.materials[mesh.materials[0]].diffuse, Rgb(1.0f));
  expectNoWarnings();
}

TEST_F(Ply, ColorsOfFacesAndOfVertices) {
  const std::string colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const auto colorOf = [&](const std::string& last) {
    const std::string vertices = "0 0 0 9 9 9\n1 0 0 9 9 9\n0 1 0 " + last + "\n";
    const SceneDescription scene =
        loadPly(ascii(replaced(kTriangleHeader, "z\n", "z\n" + colors) + colors) + vertices +
                "3 0 1 2 0 255 0\n");
    return meshOf(scene).colors[meshOf(scene).triangles[0][2]];
  };

  EXPECT_EQ(colorOf("9 9 9"), Rgb(0, 1, 0)) << "that of the face, as all vertices have one gray";
  expectNoWarnings();
  EXPECT_EQ(colorOf("255 0 0"), Rgb(1, 0, 0));
  expectWarned("colors of faces left out, because vertices have colors");
}

TEST_F(Ply, PicturesByCoordinatesOfVertices) {
  saveImage("t.tga", {"ff0000"});
  const SceneDescription scene = loadPly(
      "ply\nformat ascii 1.0\ncomment TextureFile t.tga\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nproperty float u\nproperty float v\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0 0.25 0.75\n1 0 0 0 0\n"
      "0 1 0 0 0\n3 0 1 2\n");

  const Material& material = scene.materials[0];
  ASSERT_NE(material.diffuseMap, kNoTexture);
  EXPECT_EQ(material.diffuse, Rgb(1.0f));
  EXPECT_EQ(meshOf(scene).uvs[0], (Vec2f{0.25f, 0.75f}));
}

// Images are numbered in the order of the comments. Coordinates belong to the corners of faces.
TEST_F(Ply, PicturesByCoordinatesOfFaces) {
  saveImage("red.tga", {"ff0000"});
  saveImage("blue.tga", {"0000ff"});

  const SceneDescription scene =
      loadPly(ascii(std::string("comment TextureFile red.tga\ncomment TextureFile blue.tga\n") +
                    kFourVertices + kTwoFaces +
                    "property list uchar float texcoord\nproperty int texnumber\n") +
              kCorners + "3 0 1 2 6 0 0 1 0 1 1 1\n3 0 2 3 6 0.5 0.5 1 1 0 1 0\n");

  const Mesh& mesh = meshOf(scene);
  ASSERT_EQ(mesh.materials.size(), 2u);
  EXPECT_EQ(scene.materials[mesh.materials[0]].name, "blue.tga");
  EXPECT_EQ(scene.materials[mesh.materials[1]].name, "red.tga");

  EXPECT_EQ(mesh.uvs[mesh.triangles[0][1]], (Vec2f{1, 0}));
  EXPECT_EQ(mesh.uvs[mesh.triangles[1][0]], (Vec2f{0.5f, 0.5f}));
  expectNoWarnings();
}

TEST_F(Ply, LineEndsAndCommentsAnywhere) {
  const std::string text = ascii(kTriangleHeader) + kTriangle;
  std::string dos = text.substr(0, text.size() - 1);
  for (std::size_t at = 0; (at = dos.find('\n', at)) != std::string::npos; at += 2) {
    dos.replace(at, 1, "\r\n");
  }
  expectRead("m.ply",
             {
                 {dos, "1"},
                 {ascii(kTriangleHeader) + "comment the vertices\ncomment begin\n0 0 0\n1 0 0\n"
                                           "comment one more\n0 1 0\ncomment and faces\n3 0 1 2\n",
                  "1"},
             });
}

TEST_F(Ply, WhatIsLeftOutIsCounted) {
  saveImage("t.tga", {"ff0000"});
  const std::string vertex =
      "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";

  expectRead(
      "m.ply",
      {
          {replaced(ascii(kTriangleHeader), "face 1", "face 4") +
               "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n2 0 1\n3 0 1 -1\n3 0 1 2\n",
           "1; face with a vertex index out of range dropped (2 from m.ply:14); face with fewer "
           "than three corners dropped (1 from m.ply:15)"},
          {ascii(kTriangleHeader) + "0 0 0\n1 0 0\n0 1 0\n3 0 1.5 2\n",
           "0; face with a vertex index out of range dropped (1 from m.ply:14); model with nothing "
           "to draw: no face that can be built (1 from m.ply)"},
          {ascii(std::string("comment TextureFile none.png\n") + kTriangleHeader) + kTriangle,
           "1; texture left out (1 from *"},
          {ascii(kTriangleHeader) + "0 0 0 7\n1 0 0\n0 1 0\n3 0 1 2 9 1 1 1\n",
           "1; values that no property of the header names left out (2 from m.ply:11)"},
          {ascii(std::string("comment TextureFile t.tga\ncomment TextureFile t.tga\n") +
                 kTriangleHeader + "property list uchar float texcoord\nproperty int texnumber\n") +
               "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 1 1 2\n",
           "1; face with the number of a picture that is not there (1 from m.ply:18)"},
          {ascii(vertex) + "0 0 0\n", "0; model with nothing to draw: no faces (1 from m.ply)"},
          {replaced(ascii(vertex), "vertex 1", "vertex 0"),
           "0; model with nothing to draw: no vertices (1 from m.ply)"},
          {ascii(vertex + face) + "0 0 0\n3 0 0 1\n",
           "0; face with a vertex index out of range dropped (1 from m.ply:12); model with nothing "
           "to draw: no face that can be built (1 from m.ply)"},
      });
}

TEST_F(Ply, ErrorsNameTheirPlace) {
  const std::string whole = ascii(kTriangleHeader);
  expectErrorsOf(
      "m.ply",
      {
          {"obj\n", "3 m.ply:1: expected a line \"ply\""},
          {"ply\nend_header\n", "3 m.ply:2: expected a line \"format\" before the header's end"},
          {"ply\nformat ascii 2.0\n",
           "3 m.ply:2: expected ascii, binary_little_endian or binary_big_endian, and 1.0"},
          {"ply\nformat ascii 1.0\nproperty float x\n",
           "3 m.ply:3: expected an element before its properties"},
          {"ply\nformat ascii 1.0\nelement vertex -3\n",
           "3 m.ply:3: expected the name of an element and how many there are"},
          {"ply\nformat ascii 1.0\nelement v 1\nproperty half x\n",
           "3 m.ply:4: \"half\" is no type of a property"},
          {"ply\nformat ascii 1.0", "3 m.ply:2: expected a line of a PLY header"},

          // Elements, and data that do not match them.
          {ascii("element face 1\nproperty list uchar int vertex_indices\nelement vertex 1\n"
                 "property float x\nproperty float y\nproperty float z\n") +
               "3 0 0 0\n0 0 0\n",
           "3 m.ply:4: expected the vertices before the element \"face\""},
          {whole + "0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n", "3 m.ply:12: expected a number"},
          {whole + "0 0 0\n1 0 0\n0 1 0\n255 0 1 2\n",
           "3 m.ply:14: expected a list that fits into the file"},
          {whole + "0 0 0\n1 0 0\n0 1 0\n3.5 0 1 2\n",
           "3 m.ply:14: expected a list that fits into the file"},
          {replaced(whole, "vertex 3", "vertex 18446744073709551615") + kTriangle,
           "3 m.ply:4: expected at most 26 elements \"vertex\", as many as there are bytes after "
           "the header, found 18446744073709551615"},
      });
}

TEST_F(Ply, FilesThatAreCutShortAreRefused) {
  options_.threads = 1;
  const std::string whole = binarySquare(true);
  for (const auto size : indices(whole)) {
    expectErrorsOf("m.ply", {{whole.substr(0, size), "3 *"}});
  }
}

}  // namespace
}  // namespace whit
