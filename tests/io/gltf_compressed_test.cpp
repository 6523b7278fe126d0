// glTF files with compressed meshes and textures, as gltfpack and gltf-transform write them. Each
// of tests/fuzz/corpus/gltf/{draco,webp}.glb holds the grid that expectGrid() describes.
#include <cmath>
#include <cstdlib>

#include "decoded_texel.h"
#include "fuzz/damage.h"
#include "gltf_files.h"
#include "io/gltf/document.h"
#include "scene/texture.h"

namespace whit {
namespace {

class GltfCompressed : public GltfTest {
 protected:
  static std::string bytesOfFile(const std::string& name) {
    const char* source = std::getenv("WHIT_SOURCE_DIR");
    const std::string folder = std::string(source ? source : ".") + "/tests/fuzz/corpus/gltf/";
    std::ifstream in(folder + name, std::ios::binary);
    EXPECT_TRUE(in) << folder << name;
    return {std::istreambuf_iterator<char>(in), {}};
  }
  SceneDescription loadBytes(const std::string& bytes) { return load(save("m.glb", bytes)); }
};

// Positions of 14 bits a unit and normals of 8 bits are within half a step.
constexpr double kPositionStep = 1.0 / (1 << 14), kNormalStep = 1.0 / 100, kColorStep = 1.0 / 255;

// 3 x 3 vertices over the unit square, the middle column raised by 1/4, 8 triangles that face +z,
// colors (x, y, 1).
void expectGrid(const SceneDescription& scene) {
  ASSERT_EQ(scene.objects.size(), 1u);
  const Mesh& mesh = scene.objects[0].meshes.at(0);
  EXPECT_EQ(mesh.positions.size(), 9u);
  ASSERT_EQ(mesh.triangles.size(), 8u);
  double area = 0;
  for (const auto& t : mesh.triangles) {
    std::array<Vec3d, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_LT(t[k], mesh.positions.size());
      p[k] = scene.instances.at(0).toWorld.point(Vec3d(mesh.positions[t[k]]));
      EXPECT_NEAR(p[k].z, std::abs(p[k].x - 0.5) < 0.1 ? 0.25 : 0, kPositionStep);
      EXPECT_NEAR(p[k].x * 2, std::round(p[k].x * 2), 2 * kPositionStep);
      EXPECT_NEAR(p[k].y * 2, std::round(p[k].y * 2), 2 * kPositionStep);
      expectNear(Vec3d(mesh.normals.at(t[k])), {0, 0, 1}, kNormalStep);
      EXPECT_NEAR(mesh.colors.at(t[k]).x, p[k].x, kColorStep);
      EXPECT_NEAR(mesh.colors.at(t[k]).y, p[k].y, kColorStep);
    }
    const Vec3d normal = cross(p[1] - p[0], p[2] - p[0]);
    EXPECT_GT(normal.z, 0);
    area += normal.z / 2;
  }
  EXPECT_NEAR(area, 1, 8 * kPositionStep);
}

TEST_F(GltfCompressed, DracoIsDecoded) {
  if (!GltfDocument::reads("KHR_draco_mesh_compression")) GTEST_SKIP() << "built without libdraco";
  const SceneDescription scene = loadBytes(bytesOfFile("draco.glb"));
  EXPECT_EQ(kinds(), "");
  expectGrid(scene);
  const Mesh& mesh = scene.objects[0].meshes[0];
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_NEAR(mesh.uvs[i].x, mesh.positions[i].x, 1.0 / (1 << 12));
    EXPECT_NEAR(1 - mesh.uvs[i].y, mesh.positions[i].y, 1.0 / (1 << 12));
  }
}

TEST_F(GltfCompressed, DamagedDracoEndsWithAnError) {
  if (!GltfDocument::reads("KHR_draco_mesh_compression")) GTEST_SKIP() << "built without libdraco";
  const std::string whole = bytesOfFile("draco.glb");
  const std::size_t draco = whole.rfind("DRACO");
  ASSERT_NE(draco, std::string::npos);
  std::string none = whole;
  none[draco] = 'X';
  EXPECT_EQ(errorOf([&] { loadBytes(none); }),
            "3 m.glb#/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: expected a mesh "
            "that Draco's decoder can read, but it found damaged data");
  int refused = 0;
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    const std::vector<std::uint8_t> tail(whole.begin() + static_cast<std::ptrdiff_t>(draco),
                                         whole.end());
    std::vector<std::uint8_t> bad = fuzz::damaged(tail, seed);
    bad.resize(tail.size());
    const std::string error =
        errorOf([&] { loadBytes(whole.substr(0, draco) + std::string(bad.begin(), bad.end())); });
    refused += error != "no error";
    EXPECT_TRUE(error == "no error" || error[0] == '3') << error;
  }
  EXPECT_GT(refused, 10);
}

// The compressed data decide, as in other readers.
TEST_F(GltfCompressed, WrongCountsOfDracoAccessorsDoNotMatter) {
  if (!GltfDocument::reads("KHR_draco_mesh_compression")) GTEST_SKIP() << "built without libdraco";
  std::string text = bytesOfFile("draco.glb");
  for (std::size_t at; (at = text.find("\"count\":9")) != std::string::npos;) text[at + 8] = '8';
  expectGrid(loadBytes(text));
}

TEST_F(GltfCompressed, WebpTexturesAreRead) {
  if (!GltfDocument::reads("EXT_texture_webp")) GTEST_SKIP() << "built without libwebp";
  const SceneDescription scene = loadBytes(bytesOfFile("webp.glb"));
  EXPECT_EQ(kinds(), "");
  expectGrid(scene);
  const Texture& texture =
      scene.textures.at(static_cast<std::size_t>(scene.materials.at(0).diffuseMap));
  EXPECT_EQ(decodeColorTexel(texture.texels.at(0)), Rgb(1, 0, 0));
  EXPECT_EQ(decodeColorTexel(texture.texels.at(2)), Rgb(0, 0, 1));
}

TEST_F(GltfCompressed, MissingExtensionsAreRefusedWithAdvice) {
  EXPECT_EQ(errorOfText("{\"asset\":{\"version\":\"2.0\"},\"extensionsRequired\":"
                        "[\"KHR_texture_basisu\"]}"),
            "3 m.gltf#/extensionsRequired/0: the file cannot be shown without KHR_texture_basisu, "
            "which is not supported: `gltf-transform ktxdecompress IN OUT` converts the file");
}

}  // namespace
}  // namespace whit
