#include "io/gltf/schema.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "core/error.h"
#include "io/gltf/paths.h"

namespace whit {

namespace {

// The table of what glTF's schemas say of each property that is read here.

enum class GltfKind { object, list, number, text, flag, whole, index, indices, vector };

struct GltfRule {
  const char* path;  // from the root, see gltf_paths.h
  GltfKind kind;
  std::uint64_t limit = 0;     // whole: the largest; vector: how many numbers
  const char* list = nullptr;  // index, indices: the path of the list they refer to
};

using Kind = GltfKind;

constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 53;  // what JSON numbers hold exactly

constexpr char kLightsPath[] = "extensions/KHR_lights_punctual/lights";

constexpr GltfRule kRules[] = {
    {"+asset", Kind::object},
    {"asset/+version", Kind::text},
    {"extensionsUsed", Kind::list},
    {"extensionsUsed/*", Kind::text},
    {"extensionsRequired", Kind::list},
    {"extensionsRequired/*", Kind::text},
    {"extensions", Kind::object},
    {"extensions/KHR_lights_punctual", Kind::object},
    {kLightsPath, Kind::list},
    {"extensions/KHR_lights_punctual/lights/*", Kind::object},
    {"extensions/KHR_lights_punctual/lights/*/+type", Kind::text},
    {"extensions/KHR_lights_punctual/lights/*/name", Kind::text},
    {"extensions/KHR_lights_punctual/lights/*/color", Kind::vector, 3},
    {"extensions/KHR_lights_punctual/lights/*/intensity", Kind::number},
    {"extensions/KHR_lights_punctual/lights/*/range", Kind::number},
    {"extensions/KHR_lights_punctual/lights/*/spot", Kind::object},
    {"extensions/KHR_lights_punctual/lights/*/spot/innerConeAngle", Kind::number},
    {"extensions/KHR_lights_punctual/lights/*/spot/outerConeAngle", Kind::number},

    {"buffers", Kind::list},
    {"buffers/*", Kind::object},
    {"buffers/*/uri", Kind::text},
    {"buffers/*/+byteLength", Kind::whole, kMostBytes},
    {"bufferViews", Kind::list},
    {"bufferViews/*", Kind::object},
    {"bufferViews/*/+buffer", Kind::index, 0, "buffers"},
    {"bufferViews/*/byteOffset", Kind::whole, kMostBytes},
    {"bufferViews/*/+byteLength", Kind::whole, kMostBytes},
    {"bufferViews/*/byteStride", Kind::whole, 252},
    {"accessors", Kind::list},
    {"accessors/*", Kind::object},
    {"accessors/*/bufferView", Kind::index, 0, "bufferViews"},
    {"accessors/*/byteOffset", Kind::whole, kMostBytes},
    {"accessors/*/+componentType", Kind::whole, 5126},
    {"accessors/*/normalized", Kind::flag},
    {"accessors/*/+count", Kind::whole, kMostBytes},
    {"accessors/*/+type", Kind::text},
    {"accessors/*/sparse", Kind::object},
    {"accessors/*/sparse/+count", Kind::whole, kMost},
    {"accessors/*/sparse/+indices", Kind::object},
    {"accessors/*/sparse/indices/+bufferView", Kind::index, 0, "bufferViews"},
    {"accessors/*/sparse/indices/byteOffset", Kind::whole, kMost},
    {"accessors/*/sparse/indices/+componentType", Kind::whole, 5126},
    {"accessors/*/sparse/+values", Kind::object},
    {"accessors/*/sparse/values/+bufferView", Kind::index, 0, "bufferViews"},
    {"accessors/*/sparse/values/byteOffset", Kind::whole, kMost},

    {"images", Kind::list},
    {"images/*", Kind::object},
    {"images/*/uri", Kind::text},
    {"images/*/bufferView", Kind::index, 0, "bufferViews"},
    {"images/*/name", Kind::text},
    {"samplers", Kind::list},
    {"samplers/*", Kind::object},
    {"samplers/*/magFilter", Kind::whole, kMost},
    {"samplers/*/wrapS", Kind::whole, kMost},
    {"samplers/*/wrapT", Kind::whole, kMost},
    {"textures", Kind::list},
    {"textures/*", Kind::object},
    {"textures/*/source", Kind::index, 0, "images"},
    {"textures/*/sampler", Kind::index, 0, "samplers"},

    {"materials", Kind::list},
    {"materials/*", Kind::object},
    {"materials/*/name", Kind::text},
    {"materials/*/emissiveFactor", Kind::vector, 3},
    {"materials/*/alphaMode", Kind::text},
    {"materials/*/alphaCutoff", Kind::number},
    {"materials/*/pbrMetallicRoughness", Kind::object},
    {"materials/*/pbrMetallicRoughness/baseColorFactor", Kind::vector, 4},
    {"materials/*/pbrMetallicRoughness/metallicFactor", Kind::number},
    {"materials/*/pbrMetallicRoughness/roughnessFactor", Kind::number},
    {"materials/*/extensions", Kind::object},
    {"materials/*/extensions/*", Kind::object},
    {"materials/*/extensions/KHR_materials_emissive_strength/emissiveStrength", Kind::number},
    {"materials/*/extensions/KHR_materials_ior/ior", Kind::number},
    {"materials/*/extensions/KHR_materials_transmission/transmissionFactor", Kind::number},
    {"materials/*/extensions/KHR_materials_volume/thicknessFactor", Kind::number},
    {"materials/*/extensions/KHR_materials_volume/attenuationDistance", Kind::number},
    {"materials/*/extensions/KHR_materials_volume/attenuationColor", Kind::vector, 3},
    {"materials/*/extensions/KHR_materials_specular/specularFactor", Kind::number},
    {"materials/*/extensions/KHR_materials_specular/specularColorFactor", Kind::vector, 3},
    {"materials/*/extensions/KHR_materials_clearcoat/clearcoatFactor", Kind::number},
    {"materials/*/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", Kind::number},

    {"meshes", Kind::list},
    {"meshes/*", Kind::object},
    {"meshes/*/name", Kind::text},
    {"meshes/*/+primitives", Kind::list},
    {"meshes/*/primitives/*", Kind::object},
    {"meshes/*/primitives/*/+attributes", Kind::object},
    {"meshes/*/primitives/*/attributes/*", Kind::index, 0, "accessors"},
    {"meshes/*/primitives/*/indices", Kind::index, 0, "accessors"},
    {"meshes/*/primitives/*/material", Kind::index, 0, "materials"},
    {"meshes/*/primitives/*/mode", Kind::whole, 6},
    {"meshes/*/primitives/*/extensions", Kind::object},
    {"meshes/*/primitives/*/targets", Kind::list},
    {"cameras", Kind::list},
    {"cameras/*", Kind::object},
    {"cameras/*/+type", Kind::text},
    {"cameras/*/name", Kind::text},
    {"cameras/*/orthographic", Kind::object},
    {"cameras/*/orthographic/+xmag", Kind::number},
    {"cameras/*/orthographic/+ymag", Kind::number},
    {"cameras/*/orthographic/+zfar", Kind::number},
    {"cameras/*/orthographic/+znear", Kind::number},
    {"cameras/*/perspective", Kind::object},
    {"cameras/*/perspective/aspectRatio", Kind::number},
    {"cameras/*/perspective/+yfov", Kind::number},
    {"cameras/*/perspective/+znear", Kind::number},
    {"nodes", Kind::list},
    {"nodes/*", Kind::object},
    {"nodes/*/name", Kind::text},
    {"nodes/*/children", Kind::indices, 0, "nodes"},
    {"nodes/*/mesh", Kind::index, 0, "meshes"},
    {"nodes/*/skin", Kind::index, 0, "skins"},
    {"nodes/*/camera", Kind::index, 0, "cameras"},
    {"nodes/*/matrix", Kind::vector, 16},
    {"nodes/*/translation", Kind::vector, 3},
    {"nodes/*/rotation", Kind::vector, 4},
    {"nodes/*/scale", Kind::vector, 3},
    {"nodes/*/extensions", Kind::object},
    {"nodes/*/extensions/KHR_lights_punctual", Kind::object},
    {"nodes/*/extensions/KHR_lights_punctual/+light", Kind::index, 0, kLightsPath},
    {"nodes/*/extensions/EXT_mesh_gpu_instancing", Kind::object},
    {"nodes/*/extensions/EXT_mesh_gpu_instancing/+attributes", Kind::object},
    {"nodes/*/extensions/EXT_mesh_gpu_instancing/attributes/*", Kind::index, 0, "accessors"},
    {"scenes", Kind::list},
    {"scenes/*", Kind::object},
    {"scenes/*/nodes", Kind::indices, 0, "nodes"},
    {"scene", Kind::index, 0, "scenes"},
};

constexpr const char* kTextureSlots[] = {
    "pbrMetallicRoughness/baseColorTexture",
    "pbrMetallicRoughness/metallicRoughnessTexture",
    "normalTexture",
    "emissiveTexture",
    "extensions/KHR_materials_transmission/transmissionTexture",
    "extensions/KHR_materials_specular/specularTexture",
    "extensions/KHR_materials_specular/specularColorTexture",
    "extensions/KHR_materials_clearcoat/clearcoatTexture",
    "extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture",
};
constexpr GltfRule kTextureRules[] = {
    {"", Kind::object},
    {"/+index", Kind::index, 0, "textures"},
    {"/texCoord", Kind::whole, 1000},
    {"/scale", Kind::number},
    {"/extensions", Kind::object},
    {"/extensions/KHR_texture_transform", Kind::object},
    {"/extensions/KHR_texture_transform/offset", Kind::vector, 2},
    {"/extensions/KHR_texture_transform/scale", Kind::vector, 2},
    {"/extensions/KHR_texture_transform/rotation", Kind::number},
    {"/extensions/KHR_texture_transform/texCoord", Kind::whole, 1000},
};

// Containers before what they contain. A + before the last name: the property is required.
std::span<const GltfRule> gltfRules() { return kRules; }
// Wherever a material names a texture, and what it says of it there: paths from the place on.
std::span<const char* const> gltfTextureSlots() { return kTextureSlots; }
std::span<const GltfRule> gltfTextureRules() { return kTextureRules; }

Json* find(Json& object, std::string_view name) {
  if (!object.is_object()) return nullptr;
  const auto member = object.find(std::string(name));
  return member == object.end() ? nullptr : &*member;
}

// 1e0 and 1.0 are as whole as 1.
void spellAsWhole(Json& value) {
  if (!value.is_number() || value.is_number_unsigned()) return;
  const auto number = value.get<double>();
  if (number >= 0 && number <= static_cast<double>(kMostBytes) && number == std::floor(number)) {
    value = static_cast<std::uint64_t>(number);
  }
}

class Checker {
 public:
  Checker(Json& root, const std::string& file) : root_(root), file_(file) {}

  void check(const GltfRule& rule, const std::string& path) {
    rule_ = &rule;
    target_ = rule.list ? sizeOf(rule.list) : 0;
    walkGltf(
        root_, path, "", [&](Json& value, const std::string& pointer) { look(value, pointer); },
        [&](const std::string& pointer, const std::string& name) {
          fail(pointer, "a member \"" + name + "\"");
        });
  }

 private:
  [[noreturn]] void fail(const std::string& pointer, const std::string& what) const {
    throwBadScene(file_ + "#" + pointer, "expected " + what);
  }

  // Of the list at the end of `path`, 0 where it is not there.
  std::uint64_t sizeOf(std::string_view path) const {
    Json* value = &root_;
    while (value && !path.empty()) {
      const std::size_t end = std::min(path.find('/'), path.size());
      value = find(*value, path.substr(0, end));
      path.remove_prefix(std::min(end + 1, path.size()));
    }
    return value && value->is_array() ? value->size() : 0;
  }

  void look(Json& value, const std::string& pointer) const {
    switch (rule_->kind) {
      case GltfKind::object:
        if (!value.is_object()) fail(pointer, "an object");
        break;
      case GltfKind::list:
        checkList(value, pointer);
        break;
      case GltfKind::number:
        if (!value.is_number()) fail(pointer, "a number");
        break;
      case GltfKind::text:
        if (!value.is_string()) fail(pointer, "a string");
        break;
      case GltfKind::flag:
        if (!value.is_boolean()) fail(pointer, "true or false");
        break;
      case GltfKind::whole:
        checkWhole(value, pointer, rule_->limit);
        break;
      case GltfKind::index:
        checkIndex(value, pointer);
        break;
      case GltfKind::indices:
        checkList(value, pointer);
        for (std::size_t i = 0; i < value.size(); ++i) {
          checkIndex(value[i], pointer + "/" + std::to_string(i));
        }
        break;
      case GltfKind::vector:
        checkVector(value, pointer);
        break;
    }
  }

  void checkList(const Json& value, const std::string& pointer) const {
    if (!value.is_array()) fail(pointer, "a list");
    if (value.size() > kGltfCountLimit) {
      throwLimit(file_ + "#" + pointer + ": a list of " + std::to_string(value.size()) +
                 ", more than " + std::to_string(kGltfCountLimit));
    }
  }
  void checkWhole(Json& value, const std::string& pointer, std::uint64_t limit) const {
    spellAsWhole(value);
    if (value.is_number_unsigned() && value.get<std::uint64_t>() <= limit) return;
    fail(pointer, "a whole number from 0 to " + std::to_string(limit));
  }
  void checkIndex(Json& value, const std::string& pointer) const {
    spellAsWhole(value);
    if (target_ == 0) fail(pointer, std::string("no index: there are no ") + rule_->list);
    if (value.is_number_unsigned() && value.get<std::uint64_t>() < target_) return;
    fail(pointer, std::string("an index into ") + rule_->list + ", from 0 to " +
                      std::to_string(target_ - 1));
  }
  void checkVector(const Json& value, const std::string& pointer) const {
    bool right = value.is_array() && value.size() == rule_->limit;
    for (std::size_t i = 0; right && i < value.size(); ++i) right = value[i].is_number();
    if (!right) fail(pointer, std::to_string(rule_->limit) + " numbers");
  }

  Json& root_;
  const std::string& file_;
  const GltfRule* rule_ = nullptr;
  std::uint64_t target_ = 0;
};

}  // namespace

void checkGltf(Json& json, const std::string& file) {
  Checker checker(json, file);
  for (const GltfRule& rule : gltfRules()) checker.check(rule, rule.path);
  for (const char* slot : gltfTextureSlots()) {
    for (const GltfRule& rule : gltfTextureRules()) {
      checker.check(rule, std::string("materials/*/") + slot + rule.path);
    }
  }
}

std::string gltfPlace(const std::string& file, const std::string& list, std::size_t index) {
  return file + "#/" + list + "/" + std::to_string(index);
}

}  // namespace whit
