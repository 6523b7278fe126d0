// glTF's schemas as a table: what is refused of it (gltf_schema.h) is not repeated here.
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "io/gltf/faults.h"
#include "io/gltf/paths.h"

namespace whit {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

enum class GltfWant { text, flag, object, items, unique, number, above, whole, index, numbers };
using Want = GltfWant;

struct GltfWish {
  const char* path;  // see gltf_paths.h
  GltfWant want;
  double low = -kNoLimit, high = kNoLimit;  // of each number; `above`: low is not in the range
  const char* list = nullptr;               // index: what it refers to, a member of the root
  std::size_t length = 0;                   // numbers: 0 for any
};

constexpr double kRightAngle = std::numbers::pi / 2;

constexpr GltfWish kWishes[] = {
    {"asset/generator", Want::text},
    {"asset/copyright", Want::text},
    {"asset/minVersion", Want::text},
    {"extensionsUsed", Want::items},
    {"extensionsUsed", Want::unique},
    {"extensionsRequired", Want::items},
    {"extensionsRequired", Want::unique},
    {"extensions/KHR_lights_punctual/+lights", Want::items},
    {"extensions/KHR_lights_punctual/lights/*/color", Want::numbers, 0, 1},
    {"extensions/KHR_lights_punctual/lights/*/intensity", Want::number, 0},
    {"extensions/KHR_lights_punctual/lights/*/range", Want::above, 0},
    {"extensions/KHR_lights_punctual/lights/*/spot/innerConeAngle", Want::number, 0, kRightAngle},
    {"extensions/KHR_lights_punctual/lights/*/spot/outerConeAngle", Want::above, 0, kRightAngle},

    {"buffers", Want::items},
    {"buffers/*/byteLength", Want::whole, 1},
    {"buffers/*/name", Want::text},
    {"bufferViews", Want::items},
    {"bufferViews/*/byteLength", Want::whole, 1},
    {"bufferViews/*/byteStride", Want::whole, 4, 252},
    {"bufferViews/*/target", Want::whole},
    {"bufferViews/*/name", Want::text},
    {"accessors", Want::items},
    {"accessors/*/count", Want::whole, 1},
    {"accessors/*/name", Want::text},
    {"accessors/*/min", Want::items},
    {"accessors/*/max", Want::items},
    {"accessors/*/min", Want::numbers},
    {"accessors/*/max", Want::numbers},
    {"accessors/*/sparse/count", Want::whole, 1},

    {"images", Want::items},
    {"images/*/mimeType", Want::text},
    {"samplers", Want::items},
    {"samplers/*/minFilter", Want::whole},
    {"samplers/*/name", Want::text},
    {"textures", Want::items},
    {"textures/*/name", Want::text},

    {"materials", Want::items},
    {"materials/*/doubleSided", Want::flag},
    {"materials/*/alphaCutoff", Want::number, 0},
    {"materials/*/emissiveFactor", Want::numbers, 0, 1},
    {"materials/*/occlusionTexture/strength", Want::number, 0, 1},

    {"meshes", Want::items},
    {"meshes/*/primitives", Want::items},
    {"meshes/*/weights", Want::items},
    {"meshes/*/weights", Want::numbers},
    {"meshes/*/primitives/*/targets", Want::items},
    {"meshes/*/primitives/*/targets/*", Want::object},
    {"meshes/*/primitives/*/targets/*/*", Want::index, 0, 0, "accessors"},
    {"nodes", Want::items},
    {"nodes/*/children", Want::items},
    {"nodes/*/children", Want::unique},
    {"nodes/*/rotation", Want::numbers, -1, 1},
    {"nodes/*/weights", Want::items},
    {"nodes/*/weights", Want::numbers},
    {"scenes", Want::items},
    {"scenes/*/nodes", Want::items},
    {"scenes/*/nodes", Want::unique},
    {"scenes/*/name", Want::text},
    {"cameras", Want::items},
    {"cameras/*/perspective/aspectRatio", Want::above, 0},
    {"cameras/*/perspective/yfov", Want::above, 0},
    {"cameras/*/perspective/zfar", Want::above, 0},
    {"cameras/*/perspective/znear", Want::above, 0},
    {"cameras/*/orthographic/zfar", Want::above, 0},
    {"cameras/*/orthographic/znear", Want::number, 0},

    {"skins", Want::items},
    {"skins/*", Want::object},
    {"skins/*/+joints", Want::items},
    {"skins/*/joints", Want::unique},
    {"skins/*/joints/*", Want::index, 0, 0, "nodes"},
    {"skins/*/skeleton", Want::index, 0, 0, "nodes"},
    {"skins/*/inverseBindMatrices", Want::index, 0, 0, "accessors"},
    {"skins/*/name", Want::text},
    {"animations", Want::items},
    {"animations/*", Want::object},
    {"animations/*/name", Want::text},
    {"animations/*/+samplers", Want::items},
    {"animations/*/samplers/*", Want::object},
    {"animations/*/samplers/*/+input", Want::index, 0, 0, "accessors"},
    {"animations/*/samplers/*/+output", Want::index, 0, 0, "accessors"},
    {"animations/*/samplers/*/interpolation", Want::text},
    {"animations/*/+channels", Want::items},
    {"animations/*/channels/*", Want::object},
    {"animations/*/channels/*/+sampler", Want::whole, 0},
    {"animations/*/channels/*/+target", Want::object},
    {"animations/*/channels/*/target/+path", Want::text},
    {"animations/*/channels/*/target/node", Want::index, 0, 0, "nodes"},

    {"materials/*/extensions/KHR_materials_volume/thicknessFactor", Want::number, 0},
    {"materials/*/extensions/KHR_materials_volume/attenuationColor", Want::numbers, 0, 1},
    {"materials/*/extensions/KHR_materials_specular/specularColorFactor", Want::numbers, 0},
    {"materials/*/extensions/KHR_materials_sheen/sheenColorFactor", Want::numbers, 0, 1, nullptr,
     3},
    {"materials/*/extensions/KHR_materials_sheen/sheenRoughnessFactor", Want::number, 0, 1},
    {"materials/*/extensions/KHR_materials_iridescence/iridescenceFactor", Want::number, 0, 1},
    {"materials/*/extensions/KHR_materials_iridescence/iridescenceIor", Want::number, 1},
    {"materials/*/extensions/KHR_materials_iridescence/iridescenceThicknessMinimum", Want::number,
     0},
    {"materials/*/extensions/KHR_materials_iridescence/iridescenceThicknessMaximum", Want::number,
     0},
    {"materials/*/extensions/KHR_materials_anisotropy/anisotropyStrength", Want::number, 0, 1},
    {"materials/*/extensions/KHR_materials_anisotropy/anisotropyRotation", Want::number},
    {"materials/*/extensions/KHR_materials_dispersion/dispersion", Want::number, 0},
    {"materials/*/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor", Want::numbers, 0,
     1, nullptr, 4},
    {"materials/*/extensions/KHR_materials_pbrSpecularGlossiness/specularFactor", Want::numbers, 0,
     1, nullptr, 3},
    {"materials/*/extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor", Want::number, 0,
     1},
};

// Textures that materials name and nobody reads.
constexpr const char* kOtherTextures[] = {
    "occlusionTexture",
    "extensions/KHR_materials_clearcoat/clearcoatNormalTexture",
    "extensions/KHR_materials_volume/thicknessTexture",
    "extensions/KHR_materials_sheen/sheenColorTexture",
    "extensions/KHR_materials_sheen/sheenRoughnessTexture",
    "extensions/KHR_materials_iridescence/iridescenceTexture",
    "extensions/KHR_materials_iridescence/iridescenceThicknessTexture",
    "extensions/KHR_materials_anisotropy/anisotropyTexture",
    "extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture",
    "extensions/KHR_materials_pbrSpecularGlossiness/specularGlossinessTexture",
};
constexpr GltfWish kTextureWishes[] = {
    {"", Want::object},
    {"/+index", Want::index, 0, 0, "textures"},
    {"/texCoord", Want::whole, 0},
};

class PropertyChecker {
 public:
  explicit PropertyChecker(const GltfText& text) : text_(text) {}

  void check(const GltfWish& wish, const std::string& path) {
    wish_ = &wish;
    walkGltf(
        text_.root, path, "",
        [&](const Json& value, const std::string& pointer) { look(value, pointer); },
        [&](const std::string& pointer, const std::string&) {
          text_.fault("a required property is missing", pointer);
        });
  }

 private:
  void look(const Json& value, const std::string& pointer) const {
    switch (wish_->want) {
      case Want::text:
        return expectKind(value.is_string(), pointer);
      case Want::flag:
        return expectKind(value.is_boolean(), pointer);
      case Want::object:
        return expectKind(value.is_object(), pointer);
      case Want::items:
        expectKind(value.is_array(), pointer);
        if (value.is_array() && value.empty()) text_.fault("an empty list", pointer);
        return;
      case Want::unique:
        return lookForTwins(value, pointer);
      case Want::numbers:
        return lookAtNumbers(value, pointer);
      case Want::index:
        return lookAtIndex(value, pointer);
      default:
        return lookAtNumber(value, pointer);
    }
  }

  void expectKind(bool right, const std::string& pointer) const {
    if (!right) text_.fault("a property of another kind than it has to be", pointer);
  }

  void lookForTwins(const Json& value, const std::string& pointer) const {
    if (!value.is_array()) return;
    std::set<std::string> seen;
    for (const Json& element : value) {
      if (!seen.insert(element.dump(-1, ' ', false, Json::error_handler_t::replace)).second)
        text_.fault("an element that is there twice", pointer);
    }
  }

  void lookAtNumber(const Json& value, const std::string& pointer) const {
    expectKind(value.is_number(), pointer);
    if (!value.is_number()) return;
    const auto x = value.get<double>();
    const bool low = wish_->want == Want::above ? x > wish_->low : x >= wish_->low;
    if (!low || !(x <= wish_->high)) return text_.fault("a number out of its range", pointer);
    expectKind(wish_->want != Want::whole || x == std::floor(x), pointer);
  }

  void lookAtNumbers(const Json& value, const std::string& pointer) const {
    expectKind(value.is_array(), pointer);
    if (!value.is_array()) return;
    if (wish_->length != 0 && value.size() != wish_->length) {
      text_.fault("a list of another length than it has to be", pointer);
    }
    for (const Json& element : value) lookAtNumber(element, pointer);
  }

  void lookAtIndex(const Json& value, const std::string& pointer) const {
    const std::size_t size = text_.list(wish_->list).size();
    if (!LooseJson(value).index(size)) text_.fault("an index to nothing", pointer);
  }

  const GltfText& text_;
  const GltfWish* wish_ = nullptr;
};

bool isVersion(std::string_view text) {
  const std::size_t point = text.find('.');
  const auto digits = [](std::string_view part) {
    return !part.empty() && part.find_first_not_of("0123456789") == std::string_view::npos;
  };
  return point != std::string_view::npos && digits(text.substr(0, point)) &&
         digits(text.substr(point + 1));
}

void countVersionFaults(const GltfText& text) {
  const LooseJson asset = LooseJson(text.root)["asset"];
  const std::string_view version = asset["version"].text(), least = asset["minVersion"].text();
  for (const std::string_view one : {version, least}) {
    if (!one.empty() && !isVersion(one)) text.fault("a version that is no number", "/asset");
  }
  const bool comparable = isVersion(version) && isVersion(least);
  if (comparable && std::stod(std::string(least)) > std::stod(std::string(version))) {
    text.fault("a least version above the version", "/asset/minVersion");
  }
}

}  // namespace

void countPropertyFaults(const GltfText& text) {
  PropertyChecker checker(text);
  for (const GltfWish& wish : kWishes) checker.check(wish, wish.path);
  for (const char* slot : kOtherTextures) {
    for (const GltfWish& wish : kTextureWishes) {
      checker.check(wish, std::string("materials/*/") + slot + wish.path);
    }
  }
  countVersionFaults(text);
}

}  // namespace whit
