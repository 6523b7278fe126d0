// glTF files that are wrong, on purpose or by accident. Each ends with an error that names the
// place, and does no other harm.

#include "gltf_files.h"

namespace whit {
namespace {

class GltfHostile : public GltfTest {
 protected:
  // Returns a complete small file, in which each test damages one thing.
  std::string wholeText() {
    const std::string position = positions(kTriangleXyz);
    const std::string rest = ",'indices':" + indices({0, 1, 2}) + ",'material':0";
    return json("'materials':[{'pbrMetallicRoughness':{'baseColorFactor':[1,1,1,1]}}]," +
                oneMesh(primitive(position, "", rest)));
  }
};

TEST_F(GltfHostile, ErrorsNameTheirPlace) {
  const std::string whole = wholeText();
  EXPECT_EQ(triangleCount(loadText(whole)), 1u);

  expectErrorsOfDamage(
      whole,
      {
          {"'version':'2.0'", "'version':'3.0'",
           "3 m.gltf#/asset/version: expected 2.0, found \"3.0\""},
          {"'version':'2.0'", "'version':'2.1','minVersion':'2.1'",
           "3 m.gltf#/asset/minVersion: expected at most 2.0, which is the version that can be "
           "read, found \"2.1\""},
          {"'asset'", "'assets'", "3 m.gltf#: expected a member \"asset\""},

          // Accessors.
          {"'count':3", "'count':4",
           "3 m.gltf#/accessors/0: expected at most 3 elements, as many as fit into buffer view 0, "
           "found 4"},
          {"'count':3", "'count':9007199254740992",
           "3 m.gltf#/accessors/0: expected at most 3 elements, as many as fit into buffer view 0, "
           "found 9007199254740992"},
          {"'count':3", "'count':-1",
           "3 m.gltf#/accessors/0/count: expected a whole number from 0 to 9007199254740992, found "
           "-1"},
          {"'count':3", "'count':1e300",
           "3 m.gltf#/accessors/0/count: expected a whole number from 0 to 9007199254740992, found "
           "1e+300"},
          {"'count':3", "'byteOffset':1,'count':3",
           "3 m.gltf#/accessors/0: expected at most 2 elements, as many as fit into buffer view 0, "
           "found 3"},
          {"'count':3", "'byteOffset':9007199254740992,'count':3",
           "3 m.gltf#/accessors/0: expected at most 0 elements, as many as fit into buffer view 0, "
           "found 3"},
          {"{'bufferView':0,", "{'bufferView':7,",
           "3 m.gltf#/accessors/0/bufferView: expected an index into bufferViews, from 0 to 1, "
           "found 7"},
          {"'componentType':5126", "'componentType':5124",
           "3 m.gltf#/accessors/0/componentType: expected 5120 to 5123, 5125 or 5126, found 5124"},
          {"'VEC3'", "'VEC2'", "3 m.gltf#/accessors/0/type: expected VEC3, found \"VEC2\""},
          {"5123,'type':'SCALAR'", "5122,'type':'SCALAR'",
           "3 m.gltf#/accessors/1/componentType: expected 5121, 5123 or 5125, found 5122"},

          // Buffers and their views.
          {"'byteLength':36}", "'byteLength':360}",
           "3 m.gltf#/bufferViews/0: expected a range within the buffer's 42 bytes, found 360 from "
           "byte 0"},
          {"'byteOffset':36", "'byteOffset':9007199254740992",
           "3 m.gltf#/bufferViews/1: expected a range within the buffer's 42 bytes, found 6 from "
           "byte 9007199254740992"},
          {"'byteLength':36}", "'byteLength':36,'byteStride':8}",
           "3 m.gltf#/bufferViews/0/byteStride: expected at least the 12 bytes of an element of "
           "m.gltf#/accessors/0, found 8"},
          {"'byteLength':42", "'byteLength':43",
           "3 m.gltf#/buffers/0/byteLength: expected 43 bytes of data, found 42"},

          // Indices and attributes of primitives.
          {"'material':0", "'material':1",
           "3 m.gltf#/meshes/0/primitives/0/material: expected an index into materials, from 0 to "
           "0, found 1"},
          {"'POSITION':0", "'POSITION':'0'",
           "3 m.gltf#/meshes/0/primitives/0/attributes/POSITION: expected an index into accessors, "
           "from 0 to 1, found \"0\""},
          {"'POSITION':0", "'POSITION':0,'NORMAL':1",
           "3 m.gltf#/accessors/1/type: expected VEC3, found \"SCALAR\""},

          // Nodes, materials and scenes.
          {"{'mesh':0}", "{'mesh':0,'scale':[1,2]}",
           "3 m.gltf#/nodes/0/scale: expected 3 numbers, found [1,2]"},
          {"{'mesh':0}", "{'mesh':0,'matrix':[1]}",
           "3 m.gltf#/nodes/0/matrix: expected 16 numbers, found [1]"},
          {"[1,1,1,1]", "[1,1,1]",
           "3 m.gltf#/materials/0/pbrMetallicRoughness/baseColorFactor: expected 4 numbers, found "
           "[1,1,1]"},
          {"{'mesh':0}", "{'mesh':0},7", "3 m.gltf#/nodes/1: expected an object, found 7"},
          {"'scene':0", "'scene':3",
           "3 m.gltf#/scene: expected an index into scenes, from 0 to 0, found 3"},
          {"'nodes':[0]", "'nodes':0", "3 m.gltf#/scenes/0/nodes: expected a list, found 0"},
          {"'scene':0", "'scene':0,'extensionsRequired':['KHR_none']",
           "3 m.gltf#/extensionsRequired/0: the file cannot be shown without KHR_none, which is "
           "not supported"},
          {"data:application/octet-stream;base64,", "http://example.org/",
           "3 m.gltf#/buffers/0/uri: expected the path of a file on this machine, found "
           "http://example.org/AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAg..."},

          {"data:application/octet-stream;base64,AAA", "../", "*leaves the scene's folder*"},
      });
}

TEST_F(GltfHostile, ListsMayBeMissing) {
  const std::string start = "{'asset':{'version':'2.0'},";
  loadText(start +
           "'accessors':[{'componentType':5126,'count':1,'type':'SCALAR'},{'componentType':5126,"
           "'count':1,'type':'SCALAR'}]}");
  expectWarned("model with nothing to draw: no meshes");

  expectErrorsOf(
      "m.gltf",
      {
          {start + "'textures':[{'source':0}],'materials':[{'normalTexture':{'index':0}}]}",
           "3 m.gltf#/textures/0/source: expected an index into images, which has no elements, "
           "found 0"},
          {start + "'nodes':[{'mesh':0}]}",
           "3 m.gltf#/nodes/0/mesh: expected an index into meshes, which has no elements, found 0"},
          // Version 1 had objects in place of lists.
          {"{'asset':{'version':'1.0'},'meshes':{'m':{}}}",
           "3 m.gltf#/asset/version: expected 2.0, found \"1.0\""},
      });
}

TEST_F(GltfHostile, NodesThatAreNoTree) {
  // Each node is the child of the one before it.
  std::string chain;
  for (int i = 1; i <= 400; ++i) chain += joined("{'children':[", i, "]},");

  const std::tuple<std::string, const char*, const char*> cases[] = {
      {"{'children':[0]}", "0", "0: expected a tree, found this node twice"},
      {"{'children':[1]},{'children':[2]},{'children':[1]}", "0",
       "1: expected a tree, found this node twice"},
      {"{},{'children':[2]},{'children':[1]}", "1", "1: expected a tree, found this node twice"},
      {"{}", "0,0", "0: expected a tree, found this node twice"},
      {chain + "{}", "0", "257: nested deeper than 256 nodes"},
  };
  for (const auto& [nodes, roots, error] : cases) {
    EXPECT_EQ(errorOfText(joined("{'asset':{'version':'2.0'},'nodes':[", nodes,
                                 "],'scenes':[{'nodes':[", roots, "]}]}")),
              joined("3 m.gltf#/nodes/", error));
  }
}

TEST_F(GltfHostile, SparseIndicesOutOfRange) {
  const std::string position = accessor(-1, 5126, "VEC3", 3, sparse<float>({3}, {0, 7, 0}));
  expectErrorsOfDamage(
      json(oneMesh(primitive(position))),
      {
          {"", "",
           "3 m.gltf#/accessors/0/sparse/indices: expected indices below the accessor's count of "
           "3, found 3"},
          {"'count':1", "'count':2",
           "3 m.gltf#/accessors/0/sparse/indices: expected at most 1 elements, as many as fit into "
           "buffer view 0, found 2"},

          // An accessor without a buffer view is full of zeros, so that its count
          // is bounded by memory only.
          {"'count':3", "'count':3000000000",
           "3 m.gltf#/accessors/0: expected a buffer view for 3000000000 elements, found none"},
      });
}

TEST_F(GltfHostile, BrokenContainers) {
  const std::string whole = glb(oneMesh(triangle()));
  expectErrorsOf(
      "m.glb",
      {
          {whole, "no error"},
          {whole.substr(0, 8), "3 m.glb: byte 0: expected a header of 12 bytes, found 8"},
          {replaced(whole, "JSON", "TEXT"),
           "3 m.glb: byte 16: expected a chunk of JSON first, found 1415071060"},
          {replaced(whole, "glTF\2", "glTF\1"), "3 m.glb: byte 4: expected glTF 2, found 1"},
      });

  // A file that is cut short at any byte is refused.
  for (std::size_t size = 0; size < whole.size(); ++size) {
    expectErrorsOf("m.glb", {{whole.substr(0, size), "3 *"}});
  }
}

TEST_F(GltfHostile, DeepAndWideText) {
  const std::string deep(100000, '[');
  expectLike(errorOfText("{'asset':{'version':'2.0'},'extras':" + deep), "3 *");

  options_.maxMemoryBytes = 64 << 20;
  std::string wide;
  for (int i = 0; i < 400000; ++i) wide += "{},";

  expectLike(errorOfText("{'asset':{'version':'2.0'},'nodes':[" + wide + "{}]}"), "5 *");
}

TEST_F(GltfHostile, UnknownExtensionsAreReportedOnce) {
  loadText(
      "{'asset':{'version':'2.0'},'extensionsUsed':['KHR_materials_sheen','KHR_materials_ior']}");
  expectWarned("extension ignored: KHR_materials_sheen");
  expectWarned("model with nothing to draw: no meshes");
  EXPECT_EQ(warnings_.entries().size(), 2u);
}

// Replaces each number of a file that has one element of each kind by numbers and values of other
// types.
TEST_F(GltfHostile, ReplacedNumbers) {
  saveImage("t.tga", {"09090909"});
  const std::string attributes =
      ",'TEXCOORD_0':" + floats("VEC2", {0, 0, 1, 0, 0, 1}) + "},'indices':" + indices({0, 1, 2});
  const std::string whole = json(
      "'images':[{'uri':'t.tga'}],'samplers':[{'wrapS':33071}],'textures':[{'source':0,'sampler':0}"
      "],'materials':[{'alphaMode':'BLEND','alphaCutoff':0.5,'emissiveFactor':[1,1,1],'"
      "normalTexture':{'index':0,'scale':2},'pbrMetallicRoughness':{'metallicFactor':0.5,'"
      "roughnessFactor':0.1,'baseColorFactor':[1,1,1,0.5],'baseColorTexture':{'index':0,'texCoord':"
      "0,'extensions':{'KHR_texture_transform':{'offset':[1,2],'rotation':3,'scale':[1,1]}}}},'"
      "extensions':{'KHR_materials_ior':{'ior':1.4},'KHR_materials_transmission':{'"
      "transmissionFactor':0.5,'transmissionTexture':{'index':0}},'KHR_materials_volume':{'"
      "attenuationDistance':1,'attenuationColor':[1,0.5,0]},'KHR_materials_specular':{'"
      "specularFactor':0.5,'specularColorFactor':[1,1,1]},'KHR_materials_clearcoat':{'"
      "clearcoatFactor':1},'KHR_materials_emissive_strength':{'emissiveStrength':2}}}],'cameras':[{"
      "'type':'perspective','perspective':{'yfov':1,'znear':1,'aspectRatio':2}}],'extensions':{'"
      "KHR_lights_punctual':{'lights':[{'type':'point','intensity':2,'color':[1,1,1]}]}},'meshes':["
      "{'primitives':[{'attributes':{'POSITION':" +
      positions(kTriangleXyz) + attributes +
      ",'material':0,'mode':4}]}],'nodes':[{'mesh':0,'children':[1],'scale':[1,2,3],'rotation':[0,"
      "0,0,1],'translation':[1,2,3]},{'camera':0,'extensions':{'KHR_lights_punctual':{'light':0}}}]"
      ",'scenes':[{'nodes':[0]}],'scene':0");

  options_.threads = 1;
  options_.maxMemoryBytes = 64 << 20;
  std::size_t loaded = 0;

  const auto tryText = [&](const std::string& text) {
    try {
      bake(loadText(text));
      ++loaded;
    } catch (const Error& error) {
      EXPECT_NE(error.status(), ExitStatus::usage);
    }
  };

  tryText(whole);
  EXPECT_EQ(loaded, 1u);
  options_.sky = "none";  // the studio is always the same, and blurring it takes
                          // most of the time

  // A number begins behind a colon, a bracket or a comma.
  for (std::size_t at = 0, end = 0; end < whole.size(); at = whole.find_first_of(":[,", end)) {
    if (at == std::string::npos) break;
    end = whole.find_first_not_of("0123456789.", at + 1);
    if (end == at + 1) continue;

    for (const char* number :
         {"-1", "0", "1e-320", "0.5", "2147483648", "4294967295", "9007199254740992",
          "18446744073709551615", "1e300", "-1e300", "null", "[]", "{}", "''"}) {
      tryText(whole.substr(0, at + 1) + number + whole.substr(end));
    }
  }
  EXPECT_GT(loaded, 100u);
}

}  // namespace
}  // namespace whit
