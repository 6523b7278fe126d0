// glTF files with compressed meshes and textures, as gltfpack and gltf-transform write them. Each
// of tests/fuzz/corpus/gltf/{draco,meshopt,webp}.glb holds the grid that expectGrid() describes.
#include "gltf_files.h"
#include "io/gltf/document.h"

namespace whit {
namespace {

class GltfCompressed : public GltfTest {
 protected:
  SceneDescription loadBytes(const std::string& bytes) { return load(save("m.glb", bytes)); }
};

// Tolerances: positions have 14 bits a unit and normals 8 bits, and colors are codes of 8 bits.
constexpr double kPositionStep = 1.0 / (1 << 14), kNormalStep = 1.0 / 100, kColorStep = 1.0 / 255;

// Expects 3 x 3 vertices over the unit square, of which the middle column is raised by 1/4, 8
// triangles that face +z, and the colors (x, y, 1).
void expectGrid(const SceneDescription& scene) {
  ASSERT_EQ(scene.objects.size(), 1u);
  const Mesh& mesh = meshOf(scene);
  EXPECT_EQ(mesh.positions.size(), 9u);
  ASSERT_EQ(mesh.triangles.size(), 8u);

  double area = 0;
  for (const auto& t : mesh.triangles) {
    std::array<Vec3d, 3> p;
    for (const auto k : indices(3)) {
      ASSERT_LT(t[k], mesh.positions.size());
      p[k] = scene.instances.at(0).toWorld.point(Vec3d(mesh.positions[t[k]]));
      // x and y are multiples of 1/2.
      EXPECT_NEAR(p[k].z, std::abs(p[k].x - 0.5) < 0.1 ? 0.25 : 0, kPositionStep);
      EXPECT_NEAR(p[k].x * 2, std::round(p[k].x * 2), 2 * kPositionStep);
      EXPECT_NEAR(p[k].y * 2, std::round(p[k].y * 2), 2 * kPositionStep);
      expectNearInFloat(mesh.normals.at(t[k]), {0, 0, 1}, kNormalStep);
      EXPECT_NEAR(mesh.colors.at(t[k]).x, p[k].x, kColorStep);
      EXPECT_NEAR(mesh.colors.at(t[k]).y, p[k].y, kColorStep);
    }

    const Vec3d normal = cross(p[1] - p[0], p[2] - p[0]);
    EXPECT_GT(normal.z, 0);
    area += normal.z / 2;
  }

  EXPECT_NEAR(area, 1, 8 * kPositionStep);
}

// The other tests skip by what this expects.
TEST_F(GltfCompressed, ExtensionsAreReadWhereTheirLibrariesAre) {
#ifdef WHIT_DRACO
  EXPECT_TRUE(GltfDocument::reads("KHR_draco_mesh_compression"));
#endif
#ifdef WHIT_MESHOPT
  EXPECT_TRUE(GltfDocument::reads("EXT_meshopt_compression"));
#endif
#ifdef WHIT_WEBP
  EXPECT_TRUE(GltfDocument::reads("EXT_texture_webp"));
#endif
}

TEST_F(GltfCompressed, DracoIsDecoded) {
  if (!GltfDocument::reads("KHR_draco_mesh_compression")) GTEST_SKIP() << "built without libdraco";
  const std::string whole = corpusFile("gltf/draco.glb");
  const SceneDescription scene = loadBytes(whole);
  expectNoWarnings();
  expectGrid(scene);

  const Mesh& mesh = meshOf(scene);
  // Coordinates are quantized to 12 bits, and v points up in a mesh.
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_NEAR(mesh.uvs[i].x, mesh.positions[i].x, 1.0 / (1 << 12));
    EXPECT_NEAR(1 - mesh.uvs[i].y, mesh.positions[i].y, 1.0 / (1 << 12));
  }

  // The counts in the compressed data win over those of the accessors, as in other readers.
  std::string text = whole;
  for (std::size_t at; (at = text.find("\"count\":9")) != std::string::npos;) text[at + 8] = '8';
  expectGrid(loadBytes(text));

  std::string damaged = whole;
  damaged.at(whole.rfind("DRACO")) = 'X';
  expectErrorsOf(
      "m.glb",
      {{damaged,
        "3 m.glb#/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: expected a mesh "
        "that Draco's decoder can read, but it found damaged data"}});
}

// The file is one that gltfpack has written.
TEST_F(GltfCompressed, MeshoptIsDecoded) {
  if (!GltfDocument::reads("EXT_meshopt_compression")) GTEST_SKIP() << "without libmeshoptimizer";
  const std::string whole = corpusFile("gltf/meshopt.glb");
  expectGrid(loadBytes(whole));
  expectNoWarnings();

  // In the expected errors, "+" stands for the place and text of `size`, and "-" for the name of
  // the extension.
  const std::string size = "-/byteStride: expected a size of elements that mode and filter have";
  const Damage damages[] = {
      {"'byteStride':8,'mode'", "'byteStride':6,'mode'", "0/+, found 6"},
      {"'byteStride':2,'mode'", "'byteStride':8,'mode'", "3/+, found 8"},
      {"OCTAHEDRAL", "QUATERNION", "1/+, found 4"},
      {"'ATTRIBUTES','filter'", "'TRIANGLES' ,'filter'", "1/+, found 4"},
      {"'TRIANGLES','count':24", "'TRIANGLES','count':23",
       "3/byteLength: expected the 46 bytes that are compressed, found 48"},
      {"48,'target':34963,'extensions':{'EXT_meshopt_compression':{'buffer':0,'byteOffset':164,"
       "'byteLength':25,'byteStride':2,'mode':'TRIANGLES','count':24",
       "46,'target':34963,'extensions':{'EXT_meshopt_compression':{'buffer':0,'byteOffset':164,"
       "'byteLength':25,'byteStride':2,'mode':'TRIANGLES','count':23",
       "3/-/count: expected a multiple of 3, found 23"},
      {"'byteLength':71", "'byteLength':70",
       "0/-: expected data that meshoptimizer can decode, found damaged data"},
      {"'byteLength':25", "'byteLength':99",
       "3/-: expected a range within the buffer's 192 bytes, found 99 from byte 164"},
  };

  for (auto [what, by, error] : damages) {
    if (error[2] == '+') error.replace(2, 1, size);
    if (error[2] == '-') error.replace(2, 1, "extensions/EXT_meshopt_compression");
    const std::string damaged = replaced(whole, asJson(what), asJson(by));
    EXPECT_EQ(errorOfFile(save("m.glb", damaged)), "3 m.glb#/bufferViews/" + error);
  }
}

// meshoptimizer's encoder has made the file's data, with the modes and filters that the file of
// gltfpack lacks: positions by exponents, normals in octahedra, indices, and quaternions by which
// the triangle is shown twice, the second time turned by 180 degrees about z.
TEST_F(GltfCompressed, EveryModeAndFilterOfMeshoptIsDecoded) {
  if (!GltfDocument::reads("EXT_meshopt_compression")) GTEST_SKIP() << "without libmeshoptimizer";
  const std::string text = corpusFile("gltf/meshopt_modes.gltf");
  const SceneDescription scene = loadText(text);
  expectNoWarnings();
  ASSERT_EQ(scene.instances.size(), 2u);
  for (const std::size_t i : {0u, 1u}) {
    const double x = i == 0 ? 1 : -1;
    expectTriangle(scene, {{0, 0, 0}, {x, 0, 0}, {0, x, 0}}, i, 1e-3);
    expectNearInFloat(cornerOf(scene, 0, i), {0, 0, 0}, 1e-9);
  }

  expectNearInFloat(meshOf(scene).normals.at(0), {0, 0, 1}, 1e-3);

  // The decoded size is checked before memory is allocated.
  expectErrorsOfDamage(
      text, {{asJson("'buffer':0"), asJson("'buffer':1"),
              "3 m.gltf#/buffers/1: expected a buffer with data, found none"},
             {asJson("36,'extensions':{'EXT_meshopt_compression':{'buffer':0,'byteOffset':0,"
                     "'byteLength':53,'byteStride':12,'count':3"),
              asJson("1200000000000,'extensions':{'EXT_meshopt_compression':{'buffer':0,"
                     "'byteOffset':0,'byteLength':53,'byteStride':12,'count':100000000000"),
              "5 m.gltf#/bufferViews/0/extensions/EXT_meshopt_compression needs 100000000000 x 12 "
              "bytes, *"}});
}

TEST_F(GltfCompressed, WebpTexturesAreRead) {
  if (!GltfDocument::reads("EXT_texture_webp")) GTEST_SKIP() << "built without libwebp";
  const SceneDescription scene = loadBytes(corpusFile("gltf/webp.glb"));
  expectNoWarnings();
  expectGrid(scene);

  const std::vector<Rgb> colors = colorsOf(scene, scene.materials.at(0).diffuseMap);
  EXPECT_EQ(colors.at(0), Rgb(1, 0, 0));
  EXPECT_EQ(colors.at(2), Rgb(0, 0, 1));
}

TEST_F(GltfCompressed, MissingExtensionsAreRefusedWithAdvice) {
  expectErrorsOf(
      "m.gltf",
      {
          {"{'asset':{'version':'2.0'},'extensionsRequired':['KHR_texture_basisu']}",
           "3 m.gltf#/extensionsRequired/0: the file cannot be shown without KHR_texture_basisu, "
           "which is not supported: `gltf-transform ktxdecompress IN OUT` converts the file"},
          {"{'asset':{'version':'2.0'},'extensionsRequired':['KHR_meshopt_compression']}",
           "3 m.gltf#/extensionsRequired/0: the file cannot be shown without "
           "KHR_meshopt_compression, which is not supported: `gltfpack -c -i IN -o OUT` converts "
           "the file"},
      });
}

}  // namespace
}  // namespace whit
