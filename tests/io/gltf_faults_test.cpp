// What the glTF specification forbids and can be shown all the same: shown, and said.
#include <cmath>

#include "gltf_files.h"

namespace whit {
namespace {

using GltfFaults = GltfTest;

// A quad with all that can be wrong about vertices, moved by a skin and an animation.
class Quad {
 public:
  std::vector<float> xyz = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  std::vector<float> normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
  std::vector<float> tangents = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1};
  std::vector<float> uvs = {0, 0, 1, 0, 1, 1, 0, 1};
  std::vector<float> colors = {1, 1, 1, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::vector<std::uint8_t> joints = {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};
  std::vector<float> weights = {1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 0.25f, 0.75f, 0, 0, 0, 1, 0, 0};
  std::vector<std::uint16_t> indices = {0, 1, 2, 0, 2, 3};
  std::vector<float> matrices = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                                 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  std::vector<float> times = {0, 1};
  std::vector<float> rotations = {0, 0, 0, 1, 0, 0, 1, 0};
  std::vector<std::uint16_t> replaced = {1, 3};
  std::vector<float> by = {2, 0, 0, 0, 2, 0};

  std::string text() const {
    GltfBuilder b;
    b.positions(xyz);
    b.accessor(b.view(bytesOf(normals)), 5126, "VEC3", 4);
    b.accessor(b.view(bytesOf(tangents)), 5126, "VEC4", 4);
    b.uvs(uvs);
    b.accessor(b.view(bytesOf(colors)), 5126, "VEC3", 4);
    b.accessor(b.view(bytesOf(joints)), 5121, "VEC4", 4);
    b.accessor(b.view(bytesOf(weights)), 5126, "VEC4", 4);
    b.indices(indices);
    b.accessor(b.view(bytesOf(matrices)), 5126, "MAT4", 2);
    b.accessor(b.view(bytesOf(times)), 5126, "SCALAR", 2, ",\"min\":[0],\"max\":[1]");
    b.accessor(b.view(bytesOf(rotations)), 5126, "VEC4", 2);
    const int where = b.view(bytesOf(replaced)), what = b.view(bytesOf(by));
    b.accessor(b.view(bytesOf(xyz)), 5126, "VEC3", 4,
               ",\"min\":[0,0,0],\"max\":[2,2,0],\"sparse\":{\"count\":2,\"indices\":{"
               "\"bufferView\":" +
                   std::to_string(where) +
                   ",\"componentType\":5123},\"values\":{"
                   "\"bufferView\":" +
                   std::to_string(what) + "}}");
    return b.json(kMembers);
  }

 private:
  static constexpr char kMembers[] =
      "\"scene\":0,\"scenes\":[{\"nodes\":[0,1,3]}],\"nodes\":[{\"mesh\":0,\"skin\":0},"
      "{\"children\":[2]},{\"rotation\":[0,0,0,1]},{\"mesh\":1,\"camera\":0}],\"skins\":[{"
      "\"joints\":[1,2],\"skeleton\":1,\"inverseBindMatrices\":8}],\"animations\":[{\"samplers\":[{"
      "\"input\":9,\"output\":10}],\"channels\":[{\"sampler\":0,\"target\":{\"node\":2,"
      "\"path\":\"rotation\"}}]}],\"cameras\":[{\"type\":\"perspective\",\"perspective\":{"
      "\"yfov\":1,\"znear\":1,\"zfar\":9}}],\"materials\":[{\"alphaMode\":\"MASK\","
      "\"alphaCutoff\":0.5,\"doubleSided\":true,\"emissiveFactor\":[1,1,1]}],\"meshes\":[{"
      "\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TANGENT\":2,\"TEXCOORD_0\":3,"
      "\"COLOR_0\":4,\"JOINTS_0\":5,\"WEIGHTS_0\":6},\"indices\":7,\"material\":0}]},{"
      "\"primitives\":[{\"attributes\":{\"POSITION\":11},\"indices\":7,\"targets\":[{"
      "\"POSITION\":0}]}],\"weights\":[0]}]";
};

TEST_F(GltfFaults, OfAWholeFileThereAreNone) {
  EXPECT_EQ(triangleCount(loadText(Quad().text())), 4u);
  EXPECT_EQ(kinds(), "");
}

// What is replaced in the whole file's text, and what is said then.
struct Spoilt {
  const char *what, *by, *fault;
};
constexpr Spoilt kSpoilt[] = {
    {"\"version\":\"2.0\"", "\"version\":\"2.0\",\"generator\":5",
     "a property of another kind than it has to be"},
    {"\"version\":\"2.0\"", "\"version\":\"2.0\",\"minVersion\":\"2.1\"",
     "a least version above the version"},
    {"\"version\":\"2.0\"", "\"version\":\"2.0\",\"minVersion\":\"x\"",
     "a version that is no number"},
    {"\"doubleSided\":true", "\"doubleSided\":1", "a property of another kind than it has to be"},
    {"\"alphaCutoff\":0.5", "\"alphaCutoff\":-0.5", "a number out of its range"},
    {"\"emissiveFactor\":[1,1,1]", "\"emissiveFactor\":[2,1,1]", "a number out of its range"},
    {"\"emissiveFactor\"", "\"occlusionTexture\":{\"index\":7},\"emissiveFactor\"",
     "an index to nothing"},
    {"\"emissiveFactor\"", "\"occlusionTexture\":{},\"emissiveFactor\"",
     "a required property is missing"},
    {"\"emissiveFactor\"", "\"extensions\":{\"FOO_bar\":{}},\"emissiveFactor\"",
     "an extension is used and not declared"},
    {"\"scene\":0", "\"scene\":0,\"extensionsRequired\":[\"KHR_materials_ior\"]",
     "an extension is required and not declared"},
    {"\"scene\":0", "\"scene\":0,\"extensionsUsed\":[\"KHR_mesh_quantization\"]",
     "an extension that has to be required is not"},
    {"\"scene\":0", "\"scene\":0,\"extensionsUsed\":[\"A_b\",\"A_b\"]",
     "an element that is there twice"},
    {"\"mesh\":0,", "\"mesh\":0,\"extensions\":{\"KHR_materials_ior\":{}},",
     "an extension where it has no place"},
    {"\"scene\":0", "\"scene\":0,\"textures\":[]", "an empty list"},
    {"application/octet-stream", "image/png",
     "a buffer of another media type than there is for buffers"},
    {"\"byteLength\":48}", "\"byteLength\":48,\"target\":34963}",
     "a buffer view used as two things"},
    {"\"byteLength\":12}", "\"byteLength\":12,\"byteStride\":4}",
     "a stride of what is no data of vertices"},
    {"\"byteLength\":48}", "\"byteLength\":48,\"byteStride\":52}",
     "a stride that is longer than its buffer view"},
    {"{\"bufferView\":1,", "{\"bufferView\":0,",
     "vertices of several accessors in a view without a stride"},
    {"\"NORMAL\":1,", "\"NORMAL\":1,\"FOO\":1,", "an attribute of an unknown name"},
    {"\"NORMAL\":1,", "\"NORMAL\":1,\"TEXCOORD_2\":3,", "attributes that are not numbered from 0"},
    {"\"JOINTS_0\":5,", "", "joints without weights, or the other way round"},
    {"\"JOINTS_0\":5,", "", "a skin for a mesh without joints"},
    {"\"TEXCOORD_0\":3", "\"TEXCOORD_0\":1", "an accessor of a type that does not fit its use"},
    {"\"indices\":7", "\"indices\":5", "an accessor used as two things"},
    {"5121,\"type\":\"VEC4\"", "5121,\"normalized\":true,\"type\":\"VEC4\"",
     "an accessor of a type that does not fit its use"},
    {"5126,\"type\":\"MAT4\"", "5126,\"normalized\":true,\"type\":\"MAT4\"",
     "an accessor of this type cannot be normalized"},
    {"\"MAT4\",\"count\":2", "\"MAT4\",\"count\":1", "fewer matrices than joints"},
    {"\"MAT4\",\"count\":2", "\"MAT4\",\"count\":3",
     "an accessor that reaches beyond its buffer view"},
    {",\"min\":[0,0,0],\"max\":[1,1,0]", "", "positions without their least and largest"},
    {"\"max\":[1,1,0]", "\"max\":[1,2,0]", "bounds that are not those of the values"},
    {"\"max\":[1,1,0]", "\"max\":[1,1]", "a list of another length than it has to be"},
    {"\"min\":[0],\"max\":[1]", "\"min\":[0]", "times without their least and largest"},
    {"{\"rotation\":[0,0,0,1]}", "{\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}",
     "a moved node that has a matrix"},
    {"{\"rotation\":[0,0,0,1]}", "{\"scale\":[1,1,1],\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}",
     "a node with a matrix and what makes one"},
    {"{\"rotation\":[0,0,0,1]}", "{\"matrix\":[0,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}",
     "a matrix that flattens space"},
    {"{\"rotation\":[0,0,0,1]}", "{\"weights\":[1]}", "a property that needs another one"},
    {"\"mesh\":1,", "\"mesh\":1,\"weights\":[1,2],",
     "another number of weights than of morph targets"},
    {"\"weights\":[0]}]", "\"weights\":[0,1]}]", "another number of weights than of morph targets"},
    {"\"targets\":[{\"POSITION\":0}]", "\"targets\":[{\"NORMAL\":1}]",
     "a morph target of what the primitive does not have"},
    {"\"targets\":[{\"POSITION\":0}]", "\"targets\":[{}]", "a morph target without attributes"},
    {"\"nodes\":[0,1,3]", "\"nodes\":[0,3]",
     "a scene that shows a skinned mesh and not its joints"},
    {"\"joints\":[1,2]", "\"joints\":[1]", "a joint that the skin does not have"},
    {"\"joints\":[1,2]", "\"joints\":[1,99]", "an index to nothing"},
    {"\"joints\":[1,2]", "\"joints\":[1,3]", "a skin whose joints have no common root"},
    {"\"skeleton\":1", "\"skeleton\":2", "a skeleton that is no root of its joints"},
    {"\"input\":9", "\"input\":10", "an accessor used as two things"},
    {"\"output\":10", "\"output\":99", "an index to nothing"},
    {"\"path\":\"rotation\"", "\"path\":\"scale\"",
     "an accessor of a type that does not fit its use"},
    {"\"path\":\"rotation\"", "\"path\":\"weights\"",
     "moved weights of a mesh without morph targets"},
    {"\"VEC4\",\"count\":2", "\"VEC4\",\"count\":1", "another number of values than of times"},
    {"\"zfar\":9", "\"zfar\":1", "a camera with zfar before znear"},
    {"\"perspective\":{",
     "\"orthographic\":{\"xmag\":0,\"ymag\":1,\"zfar\":2,\"znear\":1},\"perspective\":{",
     "exactly one of two properties has to be there"},
    {"\"sparse\":{\"count\":2", "\"sparse\":{\"count\":1",
     "bounds that are not those of the values"},
};

TEST_F(GltfFaults, OfStructureAreCounted) {
  const std::string whole = Quad().text();
  for (const Spoilt& spoilt : kSpoilt) {
    Warnings warnings;
    const std::string text = replaced(whole, spoilt.what, spoilt.by);
    const std::string error = errorOf([&] { loadScene(save("m.gltf", text), options_, warnings); });
    const bool said = warnings.entries().contains(std::string("not valid glTF: ") + spoilt.fault);
    EXPECT_TRUE(said) << spoilt.by << ": expected " << spoilt.fault << " (" << error << ")";
  }
}

TEST_F(GltfFaults, OfValuesAreCounted) {
  const float nan = std::nanf(""), inf = HUGE_VALF;
  struct Case {
    std::vector<float> Quad::*values;
    std::size_t at;
    float by;
    const char* fault;
  };
  const Case cases[] = {
      {&Quad::normals, 2, 0.9f, "directions that are not of unit length"},
      {&Quad::normals, 2, nan, "values that are no numbers"},
      {&Quad::tangents, 0, 0, "directions that are not of unit length"},
      {&Quad::tangents, 3, 0.5f, "tangents without a sign"},
      {&Quad::uvs, 1, inf, "values that are no numbers"},
      {&Quad::colors, 1, 1.5f, "colors beyond 0 to 1"},
      {&Quad::weights, 0, 0.9f, "weights whose sum is not 1"},
      {&Quad::weights, 0, -1, "weights below 0"},
      {&Quad::matrices, 3, 1, "matrices of joints whose last row is not 0 0 0 1"},
      {&Quad::times, 0, 1, "times that do not increase"},
      {&Quad::times, 0, -1, "times below 0"},
      {&Quad::rotations, 3, 2, "rotations that are not of unit length"},
      {&Quad::by, 0, 3, "bounds that are not those of the values"},
  };
  for (const Case& c : cases) {
    Warnings warnings;
    Quad quad;
    (quad.*c.values)[c.at] = c.by;
    loadScene(save("m.gltf", quad.text()), options_, warnings);
    EXPECT_TRUE(warnings.entries().contains(std::string("not valid glTF: ") + c.fault)) << c.fault;
  }
}

TEST_F(GltfFaults, OfIndicesAreCounted) {
  Quad beyond, twice, backwards;
  beyond.indices[1] = 4;
  loadText(beyond.text());
  EXPECT_EQ(warned("not valid glTF: an index to a vertex that is not there"), 2u);
  twice.joints[5] = 0;
  loadText(twice.text());
  EXPECT_EQ(warned("not valid glTF: a joint that moves a vertex twice"), 1u);
  backwards.replaced = {3, 1};
  loadText(backwards.text());
  EXPECT_EQ(warned("not valid glTF: indices of replaced elements that do not increase"), 1u);
}

// Within what 8 bits a component can tell.
TEST_F(GltfFaults, RoundingIsNone) {
  Quad quad;
  quad.normals[2] = 1.006f;
  quad.weights[0] = 1.003f;
  quad.rotations[3] = 0.993f;
  loadText(quad.text());
  EXPECT_EQ(kinds(), "");
}

TEST_F(GltfFaults, OfContainersAreCounted) {
  GltfBuilder b;
  const std::string whole = b.glb(oneMesh(triangle(b)));
  const auto withChunk = [&](const std::string& chunk) {
    std::string file = whole + chunk;
    const auto length = static_cast<std::uint32_t>(file.size());
    return file.replace(8, 4, bytesOf<std::uint32_t>({length}));
  };
  const std::string twice = "a chunk that is there twice or at another place than it has to be";
  load(save("m.glb", withChunk(std::string("\4\0\0\0BIN\0data", 12))));
  EXPECT_EQ(warned("not valid glTF: " + twice), 1u);
  load(save("m.glb", withChunk(std::string("\3\0\0\0TEXTabc", 11))));
  EXPECT_EQ(warned("not valid glTF: a chunk whose length is no multiple of 4"), 1u);
  load(save("m.glb", withChunk(std::string("\4\0\0\0TEXTabcd", 12))));
  EXPECT_EQ(kinds(), "not valid glTF: " + twice +
                         "\nnot valid glTF: a chunk whose length is no multiple of 4\n");
}

TEST_F(GltfFaults, AreRefusedByStrict) {
  Warnings strict(true);
  const std::string file =
      save("m.gltf", replaced(Quad().text(), "\"alphaCutoff\":0.5", "\"alphaCutoff\":-0.5"));
  EXPECT_EQ(errorOf([&] { loadScene(file, options_, strict); }),
            "3 m.gltf#/materials/0/alphaCutoff: not valid glTF: a number out of its range (refused "
            "by --strict)");
}

}  // namespace
}  // namespace whit
