// glTF files that are valid but odd.
#include "bake/scene.h"
#include "gltf_files.h"

namespace whit {
namespace {

using GltfOdd = GltfTest;

TEST_F(GltfOdd, WholeNumbersMayBeSpelledWithExponents) {
  GltfBuilder b;
  const std::string mesh = triangle(b, ",\"indices\":1e0");
  b.indices({0, 1, 2});

  std::string text = replaced(b.json(oneMesh(mesh)), "\"count\":3", "\"count\":0.3e1");
  text = replaced(text, "\"mesh\":0", "\"mesh\":0.0");
  text = replaced(text, "\"nodes\":[0]", "\"nodes\":[0e5]");
  EXPECT_EQ(triangleCount(loadText(text)), 1u);
  EXPECT_EQ(
      errorOfText(replaced(text, "0.3e1", "0.35e1")),
      "3 m.gltf#/accessors/0/count: expected a whole number from 0 to 9007199254740992, found 3.5");

  EXPECT_EQ(errorOfText(replaced(text, "1e0", "2e0")),
            "3 m.gltf#/meshes/0/primitives/0/indices: expected an index into accessors, from 0 to "
            "1, found 2.0");
}

TEST_F(GltfOdd, IndicesWithoutAViewAreZerosButForSparseOnes) {
  GltfBuilder b;
  const int which = b.view(bytesOf<std::uint16_t>({1, 2})),
            values = b.view(bytesOf<std::uint16_t>({1, 2}));

  const std::string mesh = triangle(b, ",\"indices\":1");
  b.accessor(-1, 5123, "SCALAR", 3,
             ",\"sparse\":{\"count\":2,\"indices\":{\"bufferView\":" + std::to_string(which) +
                 ",\"componentType\":5123},\"values\":{\"bufferView\":" + std::to_string(values) +
                 "}}");

  const SceneDescription scene = loadShown(b, mesh);
  ASSERT_EQ(triangleCount(scene), 1u);
  EXPECT_EQ(cornerOf(scene, 0, 0, 1), Vec3d(1, 0, 0));
  EXPECT_EQ(cornerOf(scene, 0, 0, 2), Vec3d(0, 1, 0));

  GltfBuilder zeros;
  const std::string flat = triangle(zeros, ",\"indices\":1");
  zeros.accessor(-1, 5123, "SCALAR", 3);
  EXPECT_EQ(triangleCount(loadShown(zeros, flat)), 1u);
}

TEST_F(GltfOdd, BuffersThatNobodyUsesNeedNoData) {
  GltfBuilder b;
  const std::string whole = replaced(b.json(oneMesh(triangle(b))), "}],\"bufferViews\"",
                                     "},{\"byteLength\":9}],\"bufferViews\"");
  EXPECT_EQ(triangleCount(loadText(whole)), 1u);
  EXPECT_EQ(errorOfText(replaced(whole, "\"buffer\":0", "\"buffer\":1")),
            "3 m.gltf#/buffers/1: expected a buffer with data, found none");
}

TEST_F(GltfOdd, DataMayBeOfAnyTypeAndSpelling) {
  GltfBuilder b;
  const std::string whole = b.json(oneMesh(triangle(b)));
  const std::string usual = "data:application/octet-stream;base64,";

  for (const char* other : {"data:;base64,", "DATA:model/gltf-buffer;base64,", "DATA:;BASE64,",
                            "data:application/octet-stream;charset=x;base64,"}) {
    const SceneDescription scene = loadText(replaced(whole, usual, other));
    ASSERT_EQ(triangleCount(scene), 1u) << other;
    EXPECT_EQ(cornerOf(scene, 0, 0, 1), Vec3d(1, 0, 0)) << other;
  }

  // Bytes may be escaped; these are the letters AAAA.
  std::string codes = whole;
  codes.replace(codes.find("AAAA", codes.find(usual)), 4, "%41%41A%41");
  EXPECT_EQ(triangleCount(loadText(codes)), 1u);

  // The letters of base64 and the comma are checked.
  EXPECT_EQ(errorOfText(replaced(whole, usual, usual + "!")),
            "3 m.gltf#/buffers/0/uri: expected base64, found a letter that is none of its digits");
  EXPECT_EQ(errorOfText(replaced(whole, usual, "data:;base64;")),
            "3 m.gltf#/buffers/0/uri: expected a comma before a URI's data");
}

// Buffers and images may be data URIs, whether the file has a binary chunk or needs none.
TEST_F(GltfOdd, BinaryFilesMayHoldDataUris) {
  GltfBuilder b;
  const std::string uv = b.uvs({0, 0, 1, 0, 0, 1});
  const std::string mesh = replaced(triangle(b, ",\"material\":0"), "\"POSITION\"",
                                    "\"TEXCOORD_0\":" + uv + ",\"POSITION\"");

  const std::string members =
      "\"images\":[{\"uri\":\"data:image/vnd.radiance;base64," +
      base64("#?RGBE\n\n-Y 1 +X 1\n\x80\x80\x80\x80") +
      "\"}],\"textures\":[{\"source\":0}],\"materials\":[{\"pbrMetallicRoughness\":"
      "{\"metallicFactor\":0,\"baseColorTexture\":{\"index\":0}}}]," +
      oneMesh(mesh);

  std::string text = b.json(members);
  while (text.size() % 4 != 0) text += ' ';
  const auto word = [](std::size_t x) {
    return bytesOf<std::uint32_t>({static_cast<std::uint32_t>(x)});
  };

  // The first file has no binary chunk.
  const SceneDescription scene = load(
      save("m.glb", "glTF" + word(2) + word(20 + text.size()) + word(text.size()) + "JSON" + text));
  EXPECT_EQ(triangleCount(scene), 1u);
  EXPECT_EQ(scene.textures.size(), 1u);

  EXPECT_EQ(triangleCount(load(save("n.glb", b.glb(members)))), 1u);
  EXPECT_EQ(kinds(), "");
}

TEST_F(GltfOdd, TheFirstVersionIsRefused) {
  EXPECT_EQ(errorOfText("{\"asset\":{\"version\":\"1.0\"},\"meshes\":{\"m\":{}}}"),
            "3 m.gltf#/asset/version: expected 2.0, found \"1.0\"");
  EXPECT_EQ(errorOfFile(save("m.glb", std::string("glTF\1\0\0\0\x14\0\0\0\0\0\0\0\0\0\0\0", 20))),
            "3 m.glb: byte 4: expected glTF 2, found 1");
}

TEST_F(GltfOdd, LaterVersionsThatReadersOfThisOneUnderstandAreRead) {
  for (const char* least : {"2.0", "1.0"}) {
    loadText(std::string(R"({"asset":{"version":"2.1","minVersion":")") + least + "\"}}");
  }
}

// Two parts of one strip are joined by repeated corners, whose triangles have no area.
TEST_F(GltfOdd, StripsAreJoinedByTrianglesThatAreNoLoss) {
  GltfBuilder b;
  const std::string mesh = triangle(b, ",\"mode\":5,\"indices\":1");
  b.indices({0, 1, 2, 2, 0, 0, 1, 2});
  Scene::finalize(loadShown(b, mesh), warnings_);
  EXPECT_EQ(warned("degenerate triangle dropped"), 0u);
}

// A VRM file is a GLB with another extension.
TEST_F(GltfOdd, ModelsOfVrm) {
  GltfBuilder b;
  const std::string mesh = triangle(b);
  EXPECT_EQ(triangleCount(load(save("m.vrm", b.glb(oneMesh(mesh))))), 1u);
}

}  // namespace
}  // namespace whit
