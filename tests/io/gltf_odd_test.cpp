// glTF files that are valid but odd, values that are repaired and counted, and files that show
// nothing.
#include "gltf_files.h"

namespace whit {
namespace {

using GltfOdd = GltfTest;

TEST_F(GltfOdd, WholeNumbersMayBeSpelledWithExponents) {
  const std::string mesh = triangle(",'indices':1e0");
  indices({0, 1, 2});

  std::string text = replaced(json(oneMesh(mesh)), "'count':3", "'count':0.3e1");
  text = replaced(text, "'mesh':0", "'mesh':0.0");
  text = replaced(text, "'nodes':[0]", "'nodes':[0e5]");
  EXPECT_EQ(triangleCount(loadText(text)), 1u);
  expectErrorsOfDamage(text, {
                                 {"0.3e1", "0.35e1",
                                  "3 m.gltf#/accessors/0/count: expected a whole number from 0 to "
                                  "9007199254740992, found 3.5"},
                                 {"1e0", "2e0",
                                  "3 m.gltf#/meshes/0/primitives/0/indices: expected an index into "
                                  "accessors, from 0 to 1, found 2.0"},
                             });
}

TEST_F(GltfOdd, IndicesWithoutAViewAreZerosButForSparseOnes) {
  const auto loadIndexed = [&](const std::string& members) {
    const std::string indices = accessor(-1, 5123, "SCALAR", 3, members);
    return loadShown(triangle(",'indices':" + indices));
  };
  expectTriangle(loadIndexed(sparse<std::uint16_t>({1, 2}, {1, 2})), kTriangleCorners, 0, 0);
  EXPECT_EQ(triangleCount(loadIndexed("")), 1u);
}

TEST_F(GltfOdd, BuffersThatNobodyUsesNeedNoData) {
  const std::string whole =
      replaced(json(oneMesh(triangle())), "}],'bufferViews'", "},{'byteLength':9}],'bufferViews'");
  EXPECT_EQ(triangleCount(loadText(whole)), 1u);
  EXPECT_EQ(errorOfText(replaced(whole, "'buffer':0", "'buffer':1")),
            "3 m.gltf#/buffers/1: expected a buffer with data, found none");
}

TEST_F(GltfOdd, DataMayBeOfAnyTypeAndSpelling) {
  const std::string whole = json(oneMesh(triangle()));
  const std::string usual = "data:application/octet-stream;base64,";
  // Bytes may be escaped; these are the letters AAAA.
  for (const std::string other :
       {"data:;base64,AAAA", "DATA:model/gltf-buffer;base64,AAAA", "DATA:;BASE64,AAAA",
        "data:x/y;charset=x;base64,AAAA", "data:application/octet-stream;base64,%41%41A%41"}) {
    SCOPED_TRACE(other);
    expectTriangle(loadText(replaced(whole, usual + "AAAA", other)), kTriangleCorners, 0, 0);
  }

  // The letters of base64 and the comma are checked.
  expectErrorsOfDamage(
      whole,
      {
          {usual, usual + "!",
           "3 m.gltf#/buffers/0/uri: expected base64, found a letter that is none of its digits"},
          {usual, "data:;base64;", "3 m.gltf#/buffers/0/uri: expected a comma before a URI's data"},
      });
}

// Buffers and images may be data URIs, whether the file has a binary chunk or needs none.
TEST_F(GltfOdd, BinaryFilesMayHoldDataUris) {
  const std::string uv = ",'TEXCOORD_0':" + floats("VEC2", {0, 0, 1, 0, 0, 1});
  const std::string members = "'images':[{'uri':'data:image/vnd.radiance;base64," +
                              base64("#?RGBE\n\n-Y 1 +X 1\n\x80\x80\x80\x80") +
                              "'}],'textures':[{'source':0}],'materials':[{'pbrMetallicRoughness':{"
                              "'metallicFactor':0,'baseColorTexture':{'index':0}}}]," +
                              oneMesh(primitive(positions(kTriangleXyz), uv, ",'material':0"));

  std::string text = asJson(json(members));
  text.resize((text.size() + 3) / 4 * 4, ' ');

  // The first file has no binary chunk.
  for (const std::string& file :
       {"glTF" + word(2) + word(20 + text.size()) + word(text.size()) + "JSON" + text,
        glb(members)}) {
    const SceneDescription scene = load(save("m.glb", file));
    EXPECT_EQ(triangleCount(scene), 1u);
    EXPECT_EQ(scene.textures.size(), 1u);
  }
  expectNoWarnings();
}

TEST_F(GltfOdd, LaterVersionsThatReadersOfThisOneUnderstandAreRead) {
  for (const char* least : {"2.0", "1.0"}) {
    loadText(std::string("{'asset':{'version':'2.1','minVersion':'") + least + "'}}");
  }
}

// Two parts of one strip are joined by repeated corners, whose triangles have no area.
TEST_F(GltfOdd, StripsAreJoinedByTrianglesThatAreNoLoss) {
  const std::string joining = indices({0, 1, 2, 2, 0, 0, 1, 2});
  bake(loadShown(triangle(",'mode':5,'indices':" + joining)));
  expectWarned("degenerate triangle dropped", 0);
}

// A VRM file is a GLB with another extension.
TEST_F(GltfOdd, ModelsOfVrm) {
  EXPECT_EQ(triangleCount(load(save("m.vrm", glb(oneMesh(triangle()))))), 1u);
}

TEST_F(GltfOdd, ValuesOutOfRangeAreMended) {
  const SceneDescription scene = loadText(
      "{'asset':{'version':'2.0'},'materials':[{'emissiveFactor':[1,1,1],'extensions':{'KHR_"
      "materials_emissive_strength':{'emissiveStrength':-2}}},{'emissiveFactor':[-1,0,0]},{'"
      "extensions':{'KHR_materials_volume':{'attenuationDistance':-3}}},{'alphaMode':'blend'}]}");

  expectWarned("unknown alpha mode taken as OPAQUE");
  for (const Material& material : scene.materials) {
    EXPECT_EQ(material.emission, Rgb(0.0f));
    EXPECT_EQ(material.absorption, Rgb(0.0f));
  }
}

TEST_F(GltfOdd, NothingToDrawIsSaidWithItsReason) {
  expectRead("m.gltf", {
                           {json(""), "0; model with nothing to draw: no meshes (1 from m.gltf)"},
                           {json("'meshes':[{'primitives':[" + triangle() + "]}],'nodes':[{}]"),
                            "0; model with nothing to draw: no node shows a mesh (1 from m.gltf)"},
                           {json(oneMesh(triangle(",'mode':0"))),
                            "0; model with nothing to draw: its meshes have no triangles (1 from "
                            "m.gltf); points or lines left out (1 from *"},
                           {json(oneMesh(triangle(",'mode':0") + "," + triangle(",'mode':3") + "," +
                                         triangle(",'mode':4"))),
                            "1; points or lines left out (2 from *"},
                       });
}

TEST_F(GltfOdd, CamerasOfOneNameCanBeToldApart) {
  const SceneDescription scene = loadText(
      "{'asset':{'version':'2.0'},'cameras':[{'type':'perspective','perspective':{'yfov':1,'znear':"
      "1}}],'nodes':[{'camera':0,'name':'eye'},{'camera':0},{'camera':0,'name':'eye'},{'camera':0}]"
      "}");

  std::vector<std::string> names;
  for (const Camera& camera : scene.cameras) names.push_back(camera.name);
  EXPECT_EQ(names, (std::vector<std::string>{"eye", "camera", "eye#2", "camera#2"}));
}

}  // namespace
}  // namespace whit
