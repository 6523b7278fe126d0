// A yard in which every member of cameras, materials and lights shows, and another value for each.
#pragma once

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "scene_files.h"

namespace whit {

using PlainJson = nlohmann::json;

// A member in a scene file: the name and a value, and as JSON objects members that have to be there
// as well, and those that come with the value. Colors have three numbers, as in the library.
struct MemberRow {
  const char *name, *value;
  const char* beside = "{}";
  const char* with = "{}";
};

using MemberRows = std::vector<MemberRow>;

constexpr const char* kMatrix = "{'k': [30, 30, 18, 12], 'kSize': [36, 24]}";
constexpr const char* kCircle = "{'projection': 'equidistant'}";
constexpr const char* kTable =
    "{'projection': 'directions', 'azimuths': [-20, 0, 20], 'elevations': [-30, 0]}";

inline const MemberRows kCameraRows{
    {"eye", "[1, 2, 5]"},
    {"at", "[0, 0, 0]"},
    {"up", "[1, 1, 0]"},
    {"projection", "'panorama'"},
    {"fov", "30"},
    {"orthographicHeight", "3"},
    {"aspect", "2"},
    {"aperture", "0.5"},
    {"focus", "1", "{'aperture': 0.5}"},
    {"k", "[60, 60, 18, 12]", kMatrix},
    {"kSize", "[72, 48]", kMatrix},
    {"distortion", "[0.2, 0.1, 0, 0]", kMatrix},
    {"angle", "90", kCircle},
    {"azimuths", "[-10, 0, 40]", kTable},
    {"elevations", "[-10, 0]", kTable},
    {"stereo", "'leftRight'"},
    {"eyeDistance", "0.5", "{'stereo': 'leftRight'}"},
};

constexpr const char* kGlossy =
    "{'diffuse': [0.2, 0.2, 0.2], 'specular': [0.5, 0.5, 0.5], 'roughness': 0.4}";
constexpr const char* kMirror = "{'diffuse': [0.2, 0.2, 0.2], 'mirror': [0.6, 0.6, 0.6]}";
constexpr const char* kGlass = "{'diffuse': [0.1, 0.1, 0.1], 'transmission': [0.8, 0.8, 0.8]}";
constexpr const char* kFrosted =
    "{'diffuse': [0.1, 0.1, 0.1], 'transmission': [0.8, 0.8, 0.8],"
    "'specular': [0.04, 0.04, 0.04], 'roughness': 0.4}";

inline const MemberRows kMaterialRows{
    {"diffuse", "[0.8, 0.1, 0.1]"},
    {"diffuseMap", "'checker'"},
    {"specular", "[0.4, 0.4, 0.4]"},
    {"specularMap", "'checker'", kGlossy},
    {"roughness", "0.2", kGlossy},
    {"roughnessMap", "'dents'", kGlossy},
    {"emission", "[0, 0.5, 0]"},
    {"emissionMap", "'checker'", "{'emission': [1, 1, 1]}"},
    {"normalMap", "'dents'"},
    {"occlusionMap", "'dents'"},
    {"alphaMap", "'mask'"},
    {"alphaCutoff", "0.95", "{'alphaMap': 'mask'}"},
    {"coverage", "0.4"},
    {"coverageMap", "'mask'"},
    {"mirror", "[0.5, 0.5, 0.5]"},
    {"mirrorMap", "'checker'", kMirror},
    {"mirrorGrazing", "[0.1, 0.1, 0.1]", kMirror},
    {"transmission", "[0.9, 0.5, 0.2]"},
    {"transmissionMap", "'checker'", kGlass},
    {"thin", "true", kGlass},
    {"frosted", "true", kFrosted},
    {"ior", "1.2", kGlass},
    {"absorption", "[2, 1, 0]", kGlass},
    {"priority", "5", kGlass},
    {"diffuseReflection", "false"},
    {"glossyReflection", "false", kGlossy},
    {"castsShadow", "false"},
    {"coat", "true", kMirror},
    {"doubleSided", "false"},
};

// Of the yard's lights, one after the other.
inline const MemberRows kPointRows{
    {"type", "'spot'", "{}", "{'direction': [0, -1, 0]}"},
    {"position", "[-2, 3, 1]"},
    {"intensity", "[9, 20, 30]"},
    {"radius", "0.8"},
};
inline const MemberRows kSpotRows{
    {"direction", "[0.3, -1, 0]"},
    {"innerConeAngle", "5"},
    {"outerConeAngle", "40"},
};
inline const MemberRows kSunRows{{"irradiance", "[0.5, 0, 0]"}};

inline PlainJson parse(const char* text) { return PlainJson::parse(asJson(text)); }

inline PlainJson yard() {
  return parse(
      "{'whit': 1, 'size': [36, 24],"
      "'cameras': {'main': {'eye': [0, 1.6, 4], 'at': [0, 0.7, 0], 'fov': 50}},"
      "'lights': [{'type': 'point', 'position': [2, 3, 2], 'intensity': [20, 20, 20],"
      "'radius': 0.3},"
      "{'type': 'spot', 'position': [-1.5, 4, 1], 'direction': [0, -1, 0],"
      "'intensity': [40, 30, 20], 'innerConeAngle': 15, 'outerConeAngle': 25},"
      "{'type': 'directional', 'direction': [-1, -2, -1], 'irradiance': [0.3, 0.3, 0.3]}],"
      "'sky': {'zenith': [0.2, 0.4, 0.9], 'horizon': [1, 0.9, 0.8], 'ground': [0.3, 0.2, 0.1]},"
      "'ambient': {'up': 0.2, 'down': 0.1, 'occlusion': 1.5, 'reflection': 1},"

      "'textures': {'checker': {'pattern': 'checker', 'size': 32, 'columns': 6, 'rows': 6},"
      "'dents': {'pattern': 'bricksNormals', 'size': 32, 'depth': 0.05},"
      "'mask': {'pattern': 'leafMask', 'size': 32}},"
      "'materials': {'floor': {'diffuse': 0.5}, 'a': {'diffuse': [0.6, 0.6, 0.6]},"
      "'glossy': {'diffuse': 0.1, 'specular': 0.6, 'roughness': 0.5},"
      "'glass': {'diffuse': 0, 'transmission': 0.9, 'ior': 1.5, 'priority': 1}},"
      "'scene': [{'shape': 'quad', 'width': 9, 'depth': 9, 'material': 'floor'},"
      "{'shape': 'icosphere', 'radius': 0.7, 'level': 2, 'material': 'glossy',"
      "'transform': {'translate': [1.3, 0.7, 0]}},"
      "{'shape': 'icosphere', 'radius': 0.35, 'level': 2, 'material': 'glass',"
      "'transform': {'translate': [0.2, 0.7, 0.5]}},"
      "{'shape': 'icosphere', 'radius': 0.6, 'level': 2, 'material': 'a',"
      "'transform': {'translate': [-0.2, 0.7, 0]}},"
      "{'shape': 'quad', 'width': 1.2, 'depth': 1.2, 'material': 'a',"
      "'transform': {'rotate': [1, 0, 0, -80], 'translate': [-1.4, 0.8, 0.4]}}]}");
}

// Returns a noun of the yard as the row needs it, and the same with the row's value.
inline std::pair<PlainJson, PlainJson> withoutAndWith(const MemberRow& row, PlainJson noun) {
  noun.merge_patch(parse(row.beside));
  PlainJson changed = noun;
  changed.update(parse(row.with));
  changed[row.name] = parse(row.value);
  return {noun, changed};
}

}  // namespace whit
