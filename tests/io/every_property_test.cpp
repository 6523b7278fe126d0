// Nothing is dropped silently: every property that MTL, PLY and glTF define changes the scene or is
// named in a message.
#include <cstring>
#include <nlohmann/json.hpp>

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

// The bytes of all that a picture depends on, by the name of the member or of the part of a mesh.
using Content = std::map<std::string, std::string>;

template <typename Noun>
void addMembers(const std::vector<Noun>& nouns, Content& to) {
  for (const Noun& noun : nouns) {
    forEachMember<Noun>(
        [&](const auto& member) { append(noun.*member.field, to[member.name] += '|'); });
  }
}

Content contentOf(const SceneDescription& scene) {
  Content all{{"size", std::to_string(scene.width)}};
  addMembers(scene.materials, all);
  addMembers(scene.cameras, all);
  addMembers(scene.lights, all);

  for (const Texture& texture : scene.textures) {
    appendAll(texture.rows(), all["texels"]);
    append(texture.wrapU, all["wrapU"]);
    append(texture.wrapV, all["wrapV"]);
    append(texture.nearest, all["nearest"]);
  }

  for (const Object& object : scene.objects) {
    for (const Mesh& mesh : object.meshes) {
      appendAll(mesh.positions, all["positions"]);
      appendAll(mesh.normals, all["normals"]);
      appendAll(mesh.uvs, all["uvs"]);
      appendAll(mesh.secondUvs, all["secondUvs"]);
      appendAll(mesh.colors, all["colors"]);
      appendAll(mesh.triangles, all["triangles"]);
      appendAll(mesh.materials, all["slots"]);
    }
  }

  for (const Instance& instance : scene.instances) append(instance.toWorld, all["toWorld"]);
  return all;
}

class EveryProperty : public GltfTest {
 protected:
  EveryProperty() {
    saveImage("t.tga", {"c86432", "0a141e", "ffffff", "5a80ff"}, 2);
    saveImage("g.tga", {"ff", "40"});
    saveImage("h.tga", {"00", "40", "80", "c0"});
    saveImage("a.tga", {"ffffff40"});
  }

  struct Read {
    Content content;
    std::set<std::string> messages;
  };

  Read read(const std::string& file) {
    Warnings warnings;
    Read result{contentOf(loadScene(file, options_, warnings)), {}};
    for (const auto& [kind, entry] : warnings.entries()) result.messages.insert(kind);
    return result;
  }

  // Reads a glTF file with this JSON in place of what a pointer leads to.
  Read readWith(SchemaJson file, const char* pointer, const char* value) {
    file[SchemaJson::json_pointer(pointer)] = SchemaJson::parse(asJson(value));
    return read(save("m.gltf", file.dump()));
  }

  // The names of what differs, with blanks between them.
  static std::string changesOf(const Read& with, const Read& without) {
    std::set<std::string> names;
    for (const auto& [a, b] : {std::pair(with, without), std::pair(without, with)}) {
      for (const auto& [name, bytes] : a.content) {
        const auto other = b.content.find(name);
        if (other == b.content.end() || other->second != bytes) names.insert(name);
      }
    }

    std::string all = with.messages != without.messages ? "message" : "";
    for (const std::string& name : names) all += (all.empty() ? "" : " ") + name;
    return all;
  }

  // With a property the scene differs, or there is another message.
  static void expectNoticed(const Read& with, const Read& without, const std::string& property) {
    EXPECT_NE(changesOf(with, without), "") << property;
  }
};

// Ka is the ambient reflectance of a material, for which the diffuse color stands here. The table
// therefore has map_Ka but no Ka.
TEST_F(EveryProperty, OfMtl) {
  struct Line {
    const char *line, *changes;
    const char* context = "";  // other lines, without which the line has no meaning
  };
  const Line lines[] = {
      {"Kd 1 0 0", "diffuse"},
      {"Ks 1 1 1", "specular"},
      {"Ke 1 1 1", "emission"},
      {"Tf 0.5 0.5 0.5", "transmission", "illum 4\nd 0.25\n"},
      {"Ns 10", "roughness"},
      {"Ni 2", "ior", "illum 4\nd 0.5\n"},
      {"d 0.5", "coverage"},
      {"d -halo 0.5", "coverage"},
      {"Tr 0.5", "coverage"},
      {"sharpness 60", "message"},
      {"illum 3", "glossyReflection mirror mirrorGrazing specular"},
      {"Pr 0.7", "roughness"},
      {"Pm 1", "diffuse specular vertexTint"},
      {"Ps 1", "message"},
      {"Pc 1", "mirror mirrorGrazing"},
      {"Pcr 0.5", "mirror mirrorGrazing", "Pc 1\n"},
      {"aniso 0.5", "message"},
      {"anisor 0.5", "message"},
      {"map_Kd t.tga", "diffuseMap nearest texels wrapU wrapV"},
      {"map_Ks t.tga", "mirrorMap nearest specular specularMap texels wrapU wrapV"},
      {"map_Ke t.tga", "emission emissionMap nearest texels wrapU wrapV"},
      {"map_Ka t.tga", "message"},
      {"map_Ns g.tga", "message"},
      {"map_d g.tga", "alphaMap nearest texels wrapU wrapV"},
      {"map_Tr g.tga", "message"},
      {"map_Pr g.tga", "nearest roughness roughnessMap texels wrapU wrapV"},
      {"map_Pm g.tga",
       "diffuseMap mirrorMap nearest specular specularMap texels vertexTint wrapU wrapV"},
      {"map_Ps g.tga", "message"},
      {"map_Pc g.tga", "message mirror mirrorGrazing"},
      {"map_Pcr g.tga", "message mirror mirrorGrazing", "Pc 1\n"},
      {"map_aniso g.tga", "message"},
      {"map_bump g.tga", "nearest normalMap texels wrapU wrapV"},
      {"bump t.tga", "nearest normalMap texels wrapU wrapV"},
      {"norm t.tga", "nearest normalMap texels wrapU wrapV"},
      {"disp g.tga", "message"},
      {"decal g.tga", "message"},
      {"refl -type sphere t.tga", "message"},
      {"map_refl t.tga", "message"},
      {"map_aat on", "message"},
      {"Kd spectral a.rfl 1", "message"},
      {"Kd xyz 0.1 0.2 0.3", "message"},
  };

  const auto readLines = [&](const std::string& text) {
    save("m.mtl", "newmtl m\nKd 0.5 0.5 0.5\nKs 0.5 0.5 0.5\n" + text);
    return read(save("m.obj",
                     "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\n"
                     "vt 0 1\nf 1/1 2/2 3/3\n"));
  };

  for (const Line& line : lines) {
    const std::string text = std::string(line.context) + line.line + "\n";
    EXPECT_EQ(changesOf(readLines(text), readLines(line.context)), line.changes) << line.line;
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
  // Declarations, and the values to them.
  struct Part {
    std::string declared, values;
  };
  // A triangle whose header and data are extended in the places that are given.
  struct Ply {
    std::string head = {};
    Part vertex = {}, face = {}, rest = {};
  };
  const auto readPly = [&](const Ply& ply) {
    std::string text = "ply\nformat ascii 1.0\n" + ply.head +
                       "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n" +
                       ply.vertex.declared +
                       "element face 1\nproperty list uchar int vertex_indices\n" +
                       ply.face.declared + ply.rest.declared + "end_header\n";

    for (const char* corner : {"0 0 0 ", "1 0 0 ", "0 1 0 "}) {
      text += corner + ply.vertex.values + "\n";
    }
    return read(save("m.ply", text + "3 0 1 2 " + ply.face.values + "\n" + ply.rest.values));
  };

  // Properties of one element that belong together.
  struct Properties {
    const char *names, *type, *values;
  };
  const std::pair<Part Ply::*, std::vector<Properties>> elements[] = {
      {&Ply::vertex,
       {
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
       }},
      {&Ply::face,
       {
           {"red green blue", "uchar", "255 0 9"},
           {"red", "uchar", "255"},
           {"alpha", "uchar", "7"},
           {"flags", "int", "1"},
           {"quality", "float", "1"},
           {"nx ny nz", "float", "0 0 1"},
       }},
  };

  const Read plain = readPly({});
  for (const auto& [element, properties] : elements) {
    for (const auto& [names, type, values] : properties) {
      Ply ply;
      Part& part = ply.*element;
      part.values = values;
      std::istringstream all(names);
      for (std::string name; all >> name;) {
        part.declared += joined("property ", type, " ", name, "\n");
      }
      expectNoticed(readPly(ply), plain, names);
    }
  }

  // Coordinates of the faces' corners select texels of the pictures, which comments name.
  const Part coordinates{"property list uchar float texcoord\n", "6 0 0 1 0 0 1"};
  const Part numbered{coordinates.declared + "property int texnumber\n", coordinates.values + " 1"};
  const std::string picture = "comment TextureFile t.tga\n",
                    two = picture + "comment TextureFile g.tga\n";
  const Read placed = readPly({.face = coordinates});
  expectNoticed(placed, plain, "texcoord");
  expectNoticed(readPly({.head = picture, .face = coordinates}), placed, "TextureFile");
  expectNoticed(readPly({.head = two, .face = numbered}),
                readPly({.head = two, .face = coordinates}), "texnumber");

  // Elements of other kinds are not shown, which a message says.
  for (const char* element : {"edge", "material", "camera", "user"}) {
    const Part pairs{joined("element ", element, " 1\nproperty int a\nproperty int b\n"), "0 1\n"};
    expectNoticed(readPly({.rest = pairs}), plain, element);
  }
  const Part strip{"element tristrips 1\nproperty list int int vertex_indices\n", "3 2 1 0\n"};
  expectNoticed(readPly({.rest = strip}), plain, "tristrips");
}

// The schemas also define properties that have no meaning here: names, extras, asset, the bounds of
// accessors, targets of buffer views, skeleton of skins, tangents (which follow from the
// coordinates), and the nearest and farthest distance of cameras (rays have none).
TEST_F(EveryProperty, OfGltf) {
  // A fourth vertex lies behind the triangle's, for an accessor that begins later.
  std::vector<float> corners(kTriangleXyz);
  corners.insert(corners.end(), {3, 4, 5});
  accessor(view(bytesOf(corners)), 5126, "VEC3", 3);
  floats("VEC2", {0, 0, 1, 0, 0, 1});
  floats("VEC2", {0.5f, 0, 1, 0.25f, 0, 0.75f});
  // Accessors 3, 4 and 5 are for colors, normals and indices.
  positions({1, 0, 0, 0, 1, 0, 0, 0, 1});
  positions({0, 0.6f, 0.8f, 0, 0, 1, 0, 0, 1});
  indices({2, 1, 0});

  // The file has one element of each kind, so that each pointer below leads to an existing parent.
  const SchemaJson base = SchemaJson::parse(asJson(
      json("'materials':[{'pbrMetallicRoughness':{'baseColorFactor':[0.5,0.5,0.5,0.5],"
           "'metallicFactor':0.25,'roughnessFactor':0.1,'baseColorTexture':{'index':0}},"
           "'emissiveFactor':[0.5,0.5,0.5],'extensions':{"
           "'KHR_materials_transmission':{'transmissionFactor':0.5},"
           "'KHR_materials_volume':{'thicknessFactor':1,'attenuationDistance':2,"
           "'attenuationColor':[0.5,0.5,0.5]},'KHR_materials_clearcoat':{'clearcoatFactor':0.5},"
           "'KHR_materials_specular':{'specularFactor':0.5}}},{'alphaMode':'MASK'}],"
           "'images':[{'uri':'t.tga'},{'uri':'a.tga'}],"
           "'textures':[{'source':0,'sampler':0},{'source':1}],'samplers':[{}],"
           "'meshes':[{'primitives':[{'material':0,'attributes':{'POSITION':0,'TEXCOORD_0':1,"
           "'TEXCOORD_1':2},'targets':[{'POSITION':0}]}]}],"
           "'cameras':[{'type':'perspective','perspective':{'yfov':1,'znear':1}},"
           "{'type':'orthographic','orthographic':{'xmag':1,'ymag':2,'zfar':9,'znear':0}}],"
           "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'spot','spot':{}}]}},"
           "'nodes':[{'mesh':0},{'camera':0},{'extensions':{'KHR_lights_punctual':{'light':0}}},"
           "{'camera':1},{}],'scenes':[{'nodes':[0,1,2,3,4]},{'nodes':[0]}],'scene':0")));

  // A pointer, the JSON there, and what it changes.
  struct Property {
    const char *pointer, *value, *changes;
  };
  const Property properties[] = {
      {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1,0.5,0.5,1]",
       "diffuse mirror texels transmission"},
      {"/materials/0/pbrMetallicRoughness/metallicFactor", "1",
       "diffuse diffuseMap mirror mirrorGrazing nearest specular specularMap texels "
       "transmissionMap vertexTint wrapU wrapV"},
      {"/materials/0/pbrMetallicRoughness/roughnessFactor", "0.7", "mirror roughness"},
      {"/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord", "1", "uvs"},
      {"/materials/0/pbrMetallicRoughness/metallicRoughnessTexture", "{'index':0}",
       "mirror nearest roughnessMap texels transmissionMap wrapU wrapV"},
      {"/materials/0/normalTexture", "{'index':0}",
       "nearest normalMap texels transmissionMap wrapU wrapV"},
      {"/materials/0/occlusionTexture", "{'index':0}",
       "nearest occlusionMap texels transmissionMap wrapU wrapV"},
      {"/materials/0/emissiveFactor", "[1,0,0]", "emission"},
      {"/materials/0/emissiveTexture", "{'index':0}",
       "emissionMap nearest texels transmissionMap wrapU wrapV"},
      {"/materials/0/alphaMode", "'BLEND'", "absorption coverage glossyReflection mirror"},
      {"/materials/1/alphaCutoff", "0.75", "alphaCutoff"},
      {"/materials/0/doubleSided", "true", "doubleSided"},
      {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor", "1",
       "mirror mirrorGrazing"},
      {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatTexture", "{'index':0}",
       "message mirror mirrorGrazing"},
      {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", "0.5",
       "mirror mirrorGrazing"},
      {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture", "{'index':0}",
       "message"},
      {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatNormalTexture", "{'index':0}",
       "message"},
      {"/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength", "2", "emission"},
      {"/materials/0/extensions/KHR_materials_ior/ior", "1.2", "grazingRatio ior mirror texels"},
      {"/materials/0/extensions/KHR_materials_specular/specularFactor", "1",
       "message mirror texels"},
      {"/materials/0/extensions/KHR_materials_specular/specularTexture", "{'index':1}",
       "mirror texels"},
      {"/materials/0/extensions/KHR_materials_specular/specularColorFactor", "[1,0.5,0]",
       "mirror texels"},
      {"/materials/0/extensions/KHR_materials_specular/specularColorTexture", "{'index':0}",
       "mirror texels"},
      {"/materials/0/extensions/KHR_materials_transmission/transmissionFactor", "1",
       "diffuse transmission"},
      {"/materials/0/extensions/KHR_materials_transmission/transmissionTexture", "{'index':0}",
       "diffuse texels"},
      {"/materials/0/extensions/KHR_materials_unlit", "{}",
       "message absorption castsShadow coat diffuse diffuseMap emissionMap frosted "
       "glossyReflection mirror mirrorGrazing nearest specular specularMap texels transmission "
       "transmissionMap vertexTint wrapU wrapV"},
      {"/materials/0/extensions/KHR_materials_volume/thicknessFactor", "0",
       "message absorption glossyReflection mirror thin"},
      {"/materials/0/extensions/KHR_materials_volume/thicknessTexture", "{'index':0}", "message"},
      {"/materials/0/extensions/KHR_materials_volume/attenuationDistance", "1", "absorption"},
      {"/materials/0/extensions/KHR_materials_volume/attenuationColor", "[1,0.5,0.25]",
       "absorption"},
      {"/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/offset",
       "[0.5,0]", "uvs"},
      {"/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/"
       "rotation",
       "1", "uvs"},
      {"/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/scale",
       "[2,1]", "uvs"},
      {"/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/"
       "texCoord",
       "1", "uvs"},
      {"/textures/0/source", "1", "mirror texels"},
      {"/samplers/0/wrapS", "33071", "wrapU"},
      {"/samplers/0/wrapT", "33648", "wrapV"},
      {"/samplers/0/magFilter", "9728", "nearest"},
      {"/extensions/KHR_lights_punctual/lights/0/type", "'point'", "type"},
      {"/extensions/KHR_lights_punctual/lights/0/color", "[1,0,0]", "intensity irradiance"},
      {"/extensions/KHR_lights_punctual/lights/0/intensity", "2", "intensity irradiance"},
      {"/extensions/KHR_lights_punctual/lights/0/range", "2", "message"},
      {"/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle", "0.25", "innerConeAngle"},
      {"/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle", "1", "outerConeAngle"},
      {"/nodes/0/translation", "[1,2,3]", "at eye toWorld"},
      {"/nodes/0/rotation", "[0,1,0,0]", "at eye toWorld"},
      {"/nodes/0/scale", "[2,1,1]", "at eye toWorld"},
      {"/nodes/0/matrix", "[1,0,0,0,0,1,0,0,0,0,1,0,4,0,0,1]", "at eye toWorld"},
      {"/nodes/0/weights", "[1]", "at eye positions"},
      {"/nodes/4/mesh", "0", "toWorld"},
      {"/nodes/4/camera", "1",
       "angle aperture aspect at azimuths distortion elevations eye eyeDistance focus fov k kSize "
       "orthographicHeight projection stereo up"},
      {"/nodes/0/extensions/EXT_mesh_gpu_instancing", "{'attributes':{'TRANSLATION':3}}",
       "at eye toWorld"},
      {"/meshes/0/weights", "[1]", "at eye positions"},
      {"/meshes/0/primitives/0/mode", "1",
       "message angle aperture aspect at azimuths colors distortion elevations eye eyeDistance "
       "focus fov k kSize normals orthographicHeight positions projection secondUvs slots stereo "
       "toWorld triangles up uvs"},
      {"/meshes/0/primitives/0/mode", "6", "triangles"},
      {"/meshes/0/primitives/0/indices", "5", "at eye triangles"},
      {"/meshes/0/primitives/0/material", "1", "slots"},
      {"/meshes/0/primitives/0/attributes/NORMAL", "4", "normals"},
      {"/meshes/0/primitives/0/attributes/COLOR_0", "3", "message colors"},
      {"/meshes/0/primitives/0/attributes/COLOR_1", "3", "message"},
      {"/cameras/0/perspective/yfov", "0.5", "fov"},
      {"/cameras/0/perspective/aspectRatio", "2", "aspect size"},
      {"/cameras/1/orthographic/ymag", "4", "aspect orthographicHeight"},
      {"/scene", "1",
       "message angle aperture aspect at azimuths direction distortion elevations eye eyeDistance "
       "focus fov innerConeAngle intensity irradiance k kSize orthographicHeight outerConeAngle "
       "position projection radius stereo type up"},
      {"/extensionsUsed/-", "'KHR_materials_sheen'", "message"},
      {"/accessors/0/byteOffset", "12", "at eye positions"},
      {"/accessors/1/componentType", "5123", "uvs"},
  };

  const Read plain = read(save("m.gltf", base.dump()));
  for (const auto& [pointer, value, changes] : properties) {
    EXPECT_EQ(changesOf(readWith(base, pointer, value), plain), changes) << pointer;
  }
}

// Numbers out of their range count as the nearest one within it.
TEST_F(EveryProperty, OfGltfHasALimit) {
  const SchemaJson base = SchemaJson::parse(asJson(json(
      "'materials':[{'pbrMetallicRoughness':{'metallicFactor':0.5,'roughnessFactor':0.5},"
      "'emissiveFactor':[1,1,1],'normalTexture':{'index':0},"
      "'occlusionTexture':{'index':0,'strength':0.5},'alphaMode':'BLEND','extensions':{"
      "'KHR_materials_transmission':{'transmissionFactor':0.5},"
      "'KHR_materials_volume':{'thicknessFactor':1,'attenuationDistance':2,"
      "'attenuationColor':[0.5,0.5,0.5]},"
      "'KHR_materials_clearcoat':{'clearcoatFactor':0.5,'clearcoatRoughnessFactor':0.1},"
      "'KHR_materials_specular':{'specularFactor':0.5}}},{'alphaMode':'MASK'}],"
      "'images':[{'uri':'t.tga'}],'textures':[{'source':0}],'meshes':[{'primitives':[" +
      triangle(",'material':0") + "," + triangle(",'material':1") + "]}],'nodes':[{'mesh':0}]")));

  // A pointer, the JSON of a value beyond the limit, and of the limit.
  struct Limit {
    const char *pointer, *beyond, *limit;
  };
  const Limit limits[] = {
      {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[2,0.5,0.5,0.5]", "[1,0.5,0.5,0.5]"},
      {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[0.5,-1,0.5,0.5]", "[0.5,0,0.5,0.5]"},
      {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[0.5,0.5,0.5,7]", "[0.5,0.5,0.5,1]"},
      {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[0.5,0.5,0.5,-1]", "[0.5,0.5,0.5,0]"},
      {"/materials/0/pbrMetallicRoughness/metallicFactor", "3", "1"},
      {"/materials/0/pbrMetallicRoughness/metallicFactor", "-3", "0"},
      {"/materials/0/pbrMetallicRoughness/roughnessFactor", "1.5", "1"},
      {"/materials/0/pbrMetallicRoughness/roughnessFactor", "-0.5", "0"},
      {"/materials/0/normalTexture/scale", "2000", "1000"},
      {"/materials/0/normalTexture/scale", "-2000", "-1000"},
      {"/materials/0/occlusionTexture/strength", "2", "1"},
      {"/materials/0/occlusionTexture/strength", "-1", "0"},
      {"/materials/0/emissiveFactor", "[2e9,0,0]", "[1e9,0,0]"},
      {"/materials/0/emissiveFactor", "[-1,0,0]", "[0,0,0]"},
      {"/materials/1/alphaCutoff", "-1", "0"},
      {"/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength", "2e9", "1e9"},
      {"/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength", "-1", "0"},
      {"/materials/0/extensions/KHR_materials_ior/ior", "0.5", "1"},
      {"/materials/0/extensions/KHR_materials_specular/specularFactor", "5", "1"},
      {"/materials/0/extensions/KHR_materials_specular/specularFactor", "-5", "0"},
      {"/materials/0/extensions/KHR_materials_specular/specularColorFactor", "[-1,1,1]", "[0,1,1]"},
      {"/materials/0/extensions/KHR_materials_transmission/transmissionFactor", "2", "1"},
      {"/materials/0/extensions/KHR_materials_transmission/transmissionFactor", "-2", "0"},
      {"/materials/0/extensions/KHR_materials_volume/thicknessFactor", "-1", "0"},
      {"/materials/0/extensions/KHR_materials_volume/attenuationColor", "[2,1,1]", "[1,1,1]"},
      {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor", "2", "1"},
      {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor", "-2", "0"},
      {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", "2", "1"},
      {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", "-2", "0"},
  };

  const Read plain = read(save("m.gltf", base.dump()));
  std::map<std::string, bool> isRead;
  for (const auto& [pointer, beyond, limit] : limits) {
    const Read limited = readWith(base, pointer, limit);
    EXPECT_EQ(changesOf(readWith(base, pointer, beyond), limited), "") << pointer << " " << beyond;
    isRead[pointer] |= changesOf(limited, plain) != "";
  }
  for (const auto& [pointer, is] : isRead) EXPECT_TRUE(is) << pointer << " changes nothing";
}

}  // namespace
}  // namespace whit
