// Nothing is dropped silently: every property that MTL, PLY and glTF define changes the scene or is
// named in a message.
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "gltf_files.h"
#include "scene/members.h"

namespace whit {
namespace {

using SchemaJson = nlohmann::json;

template <typename T>
void append(const T& value, std::string& to) {
  if constexpr (std::is_trivially_copyable_v<T>) {
    to.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
}

template <typename T>
void appendAll(const std::vector<T>& values, std::string& to) {
  for (const T& value : values) append(value, to);
  to += '|';
}

template <typename Noun>
void appendMembers(const std::vector<Noun>& nouns, std::string& to) {
  for (const Noun& noun : nouns) {
    forEachMember<Noun>([&](const auto& member) { append(noun.*member.field, to); });
  }
  to += '|';
}

// Returns the bytes of everything that a picture of these scenes depends on.
std::string contentOf(const SceneDescription& scene) {
  std::string all = std::to_string(scene.width) + "|";
  appendMembers(scene.materials, all);
  appendMembers(scene.cameras, all);
  appendMembers(scene.lights, all);

  for (const Texture& texture : scene.textures) {
    appendAll(texture.texels, all);
    append(texture.wrapU, all);
    append(texture.wrapV, all);
    append(texture.nearest, all);
  }

  for (const Object& object : scene.objects) {
    for (const Mesh& mesh : object.meshes) {
      appendAll(mesh.positions, all);
      appendAll(mesh.normals, all);
      appendAll(mesh.uvs, all);
      appendAll(mesh.secondUvs, all);
      appendAll(mesh.colors, all);
      appendAll(mesh.triangles, all);
      appendAll(mesh.materials, all);
    }
  }

  for (const Instance& instance : scene.instances) append(instance.toWorld, all);
  return all;
}

class EveryProperty : public GltfTest {
 protected:
  EveryProperty() {
    save("t.tga", tga(2, 2, {{200, 100, 50}, {10, 20, 30}, {255, 255, 255}, {90, 128, 255}}));
    save("g.tga", tga(2, 1, {{255}, {64}}));
    save("h.tga", tga(4, 1, {{0}, {64}, {128}, {192}}));
    save("a.tga", tga(1, 1, {{255, 255, 255, 64}}));
  }

  struct Read {
    std::string content;
    std::set<std::string> messages;
  };

  Read read(const std::string& file) {
    Warnings warnings;
    Read result{contentOf(loadScene(file, options_, warnings)), {}};
    for (const auto& [kind, entry] : warnings.entries()) result.messages.insert(kind);
    return result;
  }

  // With a property the scene differs, or there is another message.
  static void expectNoticed(const Read& with, const Read& without, const std::string& property) {
    EXPECT_TRUE(with.content != without.content || with.messages != without.messages) << property;
  }
};

// Ka is the ambient reflectance of a material, for which the diffuse color stands here. The table
// therefore has map_Ka but no Ka.
TEST_F(EveryProperty, OfMtl) {
  struct Line {
    const char* line;
    const char* context = "";  // other lines, without which the line has no meaning
  };
  const Line lines[] = {
      {"Kd 1 0 0"},
      {"Ks 1 1 1"},
      {"Ke 1 1 1"},
      {"Tf 0.5 0.5 0.5", "illum 4\nd 0.25\n"},
      {"Ns 10"},
      {"Ni 2", "illum 4\nd 0.5\n"},
      {"d 0.5"},
      {"d -halo 0.5"},
      {"Tr 0.5"},
      {"sharpness 60"},
      {"illum 3"},
      {"Pr 0.7"},
      {"Pm 1"},
      {"Ps 1"},
      {"Pc 1"},
      {"Pcr 0.5", "Pc 1\n"},
      {"aniso 0.5"},
      {"anisor 0.5"},
      {"map_Kd t.tga"},
      {"map_Ks t.tga"},
      {"map_Ke t.tga"},
      {"map_Ka t.tga"},
      {"map_Ns g.tga"},
      {"map_d g.tga"},
      {"map_Tr g.tga"},
      {"map_Pr g.tga"},
      {"map_Pm g.tga"},
      {"map_Ps g.tga"},
      {"map_Pc g.tga"},
      {"map_Pcr g.tga", "Pc 1\n"},
      {"map_aniso g.tga"},
      {"map_bump g.tga"},
      {"bump t.tga"},
      {"norm t.tga"},
      {"disp g.tga"},
      {"decal g.tga"},
      {"refl -type sphere t.tga"},
      {"map_refl t.tga"},
      {"map_aat on"},
      {"Kd spectral a.rfl 1"},
      {"Kd xyz 0.1 0.2 0.3"},
  };

  const auto readLines = [&](const std::string& text) {
    save("m.mtl", "newmtl m\nKd 0.5 0.5 0.5\nKs 0.5 0.5 0.5\n" + text);
    return read(save("m.obj",
                     "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                     "f 1/1 2/2 3/3\n"));
  };

  for (const Line& line : lines) {
    const std::string text = std::string(line.context) + line.line + "\n";
    expectNoticed(readLines(text), readLines(line.context), line.line);
  }

  const Read plain = readLines("map_Kd t.tga\n");
  for (const char* option :
       {"-s 2 2 1", "-o 0.5 0 0", "-t 1 1 1", "-mm 0.5 2", "-clamp on", "-texres 64", "-blendu off",
        "-blendv off", "-imfchan r", "-cc on", "-boost 2"}) {
    expectNoticed(readLines("map_Kd " + std::string(option) + " t.tga\n"), plain, option);
  }

  // The scale has a meaning for maps of heights only.
  expectNoticed(readLines("bump -bm 3 h.tga\n"), readLines("bump h.tga\n"), "-bm");
}

TEST_F(EveryProperty, OfPly) {
  // Properties of one element that belong together, and their values.
  struct Properties {
    const char *names, *type, *values;
  };
  const Properties ofVertices[] = {
      {"nx ny nz", "float", "0 0.6 0.8"},
      {"u v", "float", "0.5 0.25"},
      {"s t", "float", "0.5 0.25"},
      {"texture_u texture_v", "float", "0.5 0.25"},
      {"red green blue", "uchar", "255 0 9"},
      {"diffuse_red diffuse_green diffuse_blue", "uchar", "255 0 9"},
      {"r g b", "float", "1 0 0.5"},
      {"red", "uchar", "255"},
      {"alpha", "uchar", "7"},
      {"confidence", "float", "0.5"},
      {"intensity", "float", "0.5"},
      {"quality", "float", "0.5"},
      {"radius", "float", "0.5"},
      {"flags", "int", "1"},
      {"material_index", "int", "0"},
  };

  const Properties ofFaces[] = {
      {"red green blue", "uchar", "255 0 9"},
      {"red", "uchar", "255"},
      {"alpha", "uchar", "7"},
      {"flags", "int", "1"},
      {"quality", "float", "1"},
      {"nx ny nz", "float", "0 0 1"},
  };

  const auto declared = [](const Properties& p) {
    std::istringstream names(p.names);
    std::string text;
    for (std::string name; names >> name;) {
      text += std::string("property ") + p.type + " " + name + "\n";
    }
    return text;
  };

  // Loads a triangle whose header and data are extended in the places that are given.
  const auto readPly = [&](const std::string& head, const std::string& vertex,
                           const std::string& vertexValues, const std::string& face,
                           const std::string& faceValues, const std::string& rest = "",
                           const std::string& restValues = "") {
    std::string text = "ply\nformat ascii 1.0\n" + head +
                       "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n" +
                       vertex + "element face 1\nproperty list uchar int vertex_indices\n" + face +
                       rest + "end_header\n";

    for (const char* corner : {"0 0 0 ", "1 0 0 ", "0 1 0 "}) text += corner + vertexValues + "\n";
    return read(save("m.ply", text + "3 0 1 2 " + faceValues + "\n" + restValues));
  };

  const Read plain = readPly("", "", "", "", "");
  for (const Properties& p : ofVertices) {
    expectNoticed(readPly("", declared(p), p.values, "", ""), plain, p.names);
  }
  for (const Properties& p : ofFaces) {
    expectNoticed(readPly("", "", "", declared(p), p.values), plain, p.names);
  }

  // Coordinates of the faces' corners select texels of the pictures, which comments name.
  const std::string coordinates = "property list uchar float texcoord\n";
  const std::string values = "6 0 0 1 0 0 1";
  expectNoticed(readPly("", "", "", coordinates, values), plain, "texcoord");

  const std::string picture = "comment TextureFile t.tga\n";
  const Read pictured = readPly(picture, "", "", coordinates, values);
  expectNoticed(pictured, readPly("", "", "", coordinates, values), "TextureFile");

  const std::string two = picture + "comment TextureFile g.tga\n";
  expectNoticed(readPly(two, "", "", coordinates + "property int texnumber\n", values + " 1"),
                readPly(two, "", "", coordinates, values), "texnumber");

  // Elements of these kinds are not shown, which a message says.
  for (const char* element : {"edge", "material", "camera", "user"}) {
    const std::string declaration =
        std::string("element ") + element + " 1\nproperty int vertex1\nproperty int vertex2\n";
    expectNoticed(readPly("", "", "", "", "", declaration, "0 1\n"), plain, element);
  }

  expectNoticed(readPly("", "", "", "", "",
                        "element tristrips 1\nproperty list int int vertex_indices\n", "3 2 1 0\n"),
                plain, "tristrips");
}

// The schemas also define properties that have no meaning here: names, extras, asset, the bounds of
// accessors, targets of buffer views, skeleton of skins, tangents (which follow from the
// coordinates), and the nearest and farthest distance of cameras (rays have none).
TEST_F(EveryProperty, OfGltf) {
  GltfBuilder b;
  const std::string position = std::to_string(b.positions(kTriangleXyz));
  const std::string uv = std::to_string(b.uvs({0, 0, 1, 0, 0, 1}));
  const std::string second = std::to_string(b.uvs({0.5f, 0, 1, 0.25f, 0, 0.75f}));
  const int color =
      b.accessor(b.view(bytesOf<float>({1, 0, 0, 0, 1, 0, 0, 0, 1})), 5126, "VEC3", 3);
  const int normal =
      b.accessor(b.view(bytesOf<float>({0, 0.6f, 0.8f, 0, 0, 1, 0, 0, 1})), 5126, "VEC3", 3);
  const int indices = b.indices({2, 1, 0});

  const std::string slot = "{\"index\":0}";
  // The file has one element of each kind, so that each pointer below leads to an existing parent.
  const SchemaJson base = SchemaJson::parse(b.json(
      "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.5,0.5,0.5],"
      "\"metallicFactor\":0.25,\"roughnessFactor\":0.1,\"baseColorTexture\":" +
      slot +
      "},"
      "\"emissiveFactor\":[0.5,0.5,0.5],\"extensions\":{\"KHR_materials_transmission\":"
      "{\"transmissionFactor\":0.5},\"KHR_materials_volume\":{\"thicknessFactor\":1,"
      "\"attenuationDistance\":2,\"attenuationColor\":[0.5,0.5,0.5]},\"KHR_materials_clearcoat\":{"
      "\"clearcoatFactor\":0.5},"
      "\"KHR_materials_specular\":{\"specularFactor\":0.5}}},"
      "{\"alphaMode\":\"MASK\"}],"
      "\"images\":[{\"uri\":\"t.tga\"},{\"uri\":\"a.tga\"}],"
      "\"textures\":[{\"source\":0,\"sampler\":0},{\"source\":1}],\"samplers\":[{}],"
      "\"meshes\":[{\"primitives\":[{\"material\":0,\"attributes\":{\"POSITION\":" +
      position + ",\"TEXCOORD_0\":" + uv + ",\"TEXCOORD_1\":" + second +
      "},\"targets\":[{\"POSITION\":" + position +
      "}]}]}],"
      "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}},"
      "{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":1,\"ymag\":2,\"zfar\":9,\"znear\":0}}]"
      ","
      "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"spot\",\"spot\":{}}]}},"
      "\"nodes\":[{\"mesh\":0},{\"camera\":0},{\"extensions\":{\"KHR_lights_punctual\":{\"light\":"
      "0}}},"
      "{\"camera\":1},{}],\"scenes\":[{\"nodes\":[0,1,2,3,4]},{\"nodes\":[0]}],\"scene\":0"));

  const std::string material = "/materials/0/", extensions = material + "extensions/KHR_";
  const std::string pbr = material + "pbrMetallicRoughness/",
                    light = "/extensions/KHR_lights_punctual/lights/0/";
  const std::string transform = pbr + "baseColorTexture/extensions/KHR_texture_transform/";
  const std::string primitive = "/meshes/0/primitives/0/";

  const std::pair<std::string, SchemaJson> properties[] = {
      {pbr + "baseColorFactor", {1, 0.5, 0.5, 1}},
      {pbr + "metallicFactor", 1},
      {pbr + "roughnessFactor", 0.7},
      {pbr + "baseColorTexture/texCoord", 1},
      {pbr + "metallicRoughnessTexture", {{"index", 0}}},
      {material + "normalTexture", {{"index", 0}}},
      {material + "occlusionTexture", {{"index", 0}}},
      {material + "emissiveFactor", {1, 0, 0}},
      {material + "emissiveTexture", {{"index", 0}}},
      {material + "alphaMode", "BLEND"},
      {"/materials/1/alphaCutoff", 0.75},
      {material + "doubleSided", true},
      {extensions + "materials_clearcoat/clearcoatFactor", 1},
      {extensions + "materials_clearcoat/clearcoatTexture", {{"index", 0}}},
      {extensions + "materials_clearcoat/clearcoatRoughnessFactor", 0.5},
      {extensions + "materials_clearcoat/clearcoatRoughnessTexture", {{"index", 0}}},
      {extensions + "materials_clearcoat/clearcoatNormalTexture", {{"index", 0}}},
      {extensions + "materials_emissive_strength/emissiveStrength", 2},
      {extensions + "materials_ior/ior", 1.2},
      {extensions + "materials_specular/specularFactor", 1},
      {extensions + "materials_specular/specularTexture", {{"index", 1}}},
      {extensions + "materials_specular/specularColorFactor", {1, 0.5, 0}},
      {extensions + "materials_specular/specularColorTexture", {{"index", 0}}},
      {extensions + "materials_transmission/transmissionFactor", 1},
      {extensions + "materials_transmission/transmissionTexture", {{"index", 0}}},
      {extensions + "materials_unlit", SchemaJson::object()},
      {extensions + "materials_volume/thicknessFactor", 0},
      {extensions + "materials_volume/thicknessTexture", {{"index", 0}}},
      {extensions + "materials_volume/attenuationDistance", 1},
      {extensions + "materials_volume/attenuationColor", {1, 0.5, 0.25}},
      {transform + "offset", {0.5, 0}},
      {transform + "rotation", 1},
      {transform + "scale", {2, 1}},
      {transform + "texCoord", 1},
      {"/textures/0/source", 1},
      {"/samplers/0/wrapS", 33071},
      {"/samplers/0/wrapT", 33648},
      {"/samplers/0/magFilter", 9728},
      {light + "type", "point"},
      {light + "color", {1, 0, 0}},
      {light + "intensity", 2},
      {light + "range", 2},
      {light + "spot/innerConeAngle", 0.25},
      {light + "spot/outerConeAngle", 1},
      {"/nodes/0/translation", {1, 2, 3}},
      {"/nodes/0/rotation", {0, 1, 0, 0}},
      {"/nodes/0/scale", {2, 1, 1}},
      {"/nodes/0/matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4, 0, 0, 1}},
      {"/nodes/0/weights", {1}},
      {"/nodes/4/mesh", 0},
      {"/nodes/4/camera", 1},
      {"/nodes/0/extensions/EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", color}}}}},
      {"/meshes/0/weights", {1}},
      {primitive + "mode", 1},
      {primitive + "mode", 6},
      {primitive + "indices", indices},
      {primitive + "material", 1},
      {primitive + "attributes/NORMAL", normal},
      {primitive + "attributes/COLOR_0", color},
      {primitive + "attributes/COLOR_1", color},
      {"/cameras/0/perspective/yfov", 0.5},
      {"/cameras/0/perspective/aspectRatio", 2},
      {"/cameras/1/orthographic/ymag", 4},
      {"/scene", 1},
      {"/extensionsUsed/-", "KHR_materials_sheen"},
      {"/accessors/0/byteOffset", 12},
      {"/accessors/1/componentType", 5123},
  };

  const Read plain = read(save("m.gltf", base.dump()));
  for (const auto& [pointer, value] : properties) {
    SchemaJson changed = base;
    changed[SchemaJson::json_pointer(pointer)] = value;
    // Fewer elements fit behind the offset.
    if (pointer == "/accessors/0/byteOffset") changed["/accessors/0/count"_json_pointer] = 2;

    try {
      expectNoticed(read(save("m.gltf", changed.dump())), plain, pointer);
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()), "") << pointer;  // a refusal names the property
    }
  }
}

}  // namespace
}  // namespace whit
