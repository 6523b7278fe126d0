// Primitives: which accessors their attributes, morph targets and indices may be.
#include <array>
#include <map>
#include <set>
#include <vector>

#include "io/gltf/elements.h"
#include "io/gltf/uses.h"

namespace whit {
namespace {

// What an attribute may be, by its name without a number.
struct GltfSemantic {
  std::string_view name;
  bool isNumbered;
  std::array<std::string_view, 2> types;
  // f: float; n: unsigned integers of 8 or 16 bits, normalized; u: the same, not normalized;
  // q: what KHR_mesh_quantization adds, any integer of 8 or 16 bits.
  std::string_view formats;
};
constexpr GltfSemantic kSemantics[] = {
    {"POSITION", false, {"VEC3", ""}, "fq"}, {"NORMAL", false, {"VEC3", ""}, "fq"},
    {"TANGENT", false, {"VEC4", ""}, "fq"},  {"TEXCOORD", true, {"VEC2", ""}, "fnq"},
    {"COLOR", true, {"VEC3", "VEC4"}, "fn"}, {"JOINTS", true, {"VEC4", ""}, "u"},
    {"WEIGHTS", true, {"VEC4", ""}, "fn"},
};

const GltfSemantic* semanticOf(std::string_view attribute) {
  const std::size_t line = attribute.rfind('_');
  for (const GltfSemantic& one : kSemantics) {
    if (!one.isNumbered && attribute == one.name) return &one;
    if (!one.isNumbered || line == std::string_view::npos) continue;
    const std::string_view number = attribute.substr(line + 1);
    const bool digits =
        !number.empty() && number.find_first_not_of("0123456789") == std::string_view::npos;
    const bool plain = number == "0" || !number.starts_with('0');
    if (attribute.substr(0, line) == one.name && digits && plain) return &one;
  }
  return nullptr;
}

bool isSmall(const GltfAccessorShape& shape) {
  const std::size_t bytes = gltfBytesOf(shape.componentType);
  return bytes == 1 || bytes == 2;
}

class MeshChecker {
 public:
  MeshChecker(const GltfText& text, const GltfElements& elements, GltfUses& uses)
      : text_(text), elements_(elements), uses_(uses) {
    const LooseJson required = text.list("extensionsRequired");
    for (std::size_t i = 0; i < required.size(); ++i) {
      quantized_ = quantized_ || required.at(i).text() == "KHR_mesh_quantization";
    }
  }

  void check() {
    const LooseJson meshes = text_.list("meshes");
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      const LooseJson primitives = meshes.at(i)["primitives"];
      for (std::size_t k = 0; k < primitives.size(); ++k) {
        pointer_ = pointerTo("meshes", i, pointerTo("primitives", k));
        look(primitives.at(k));
      }
      lookAtWeights(meshes.at(i), pointerTo("meshes", i));
    }
    lookAtSharedViews();
  }

 private:
  using Attributes = std::map<std::string, std::size_t>;  // to accessors

  void fault(const char* what) const { text_.fault(what, pointer_); }

  void look(const LooseJson& primitive) {
    const Attributes attributes = attributesOf(primitive["attributes"]);
    if (primitive["attributes"].isObject() && primitive["attributes"].json()->empty()) {
      fault("a primitive without attributes");
    }
    for (const auto& [name, accessor] : attributes) {
      lookAtAttribute(name, accessor, true);
      if (elements_.shape(accessor).count != elements_.shape(attributes.begin()->second).count) {
        fault("attributes of different lengths");
      }
    }
    lookAtSets(attributes);
    lookAtTargets(primitive["targets"], attributes);
    lookAtIndices(primitive, attributes);
    lookAtMaterial(primitive, attributes);
  }

  Attributes attributesOf(const LooseJson& source) const {
    Attributes attributes;
    if (!source.isObject()) return attributes;
    for (const auto& [name, value] : source.json()->items()) {
      if (const auto accessor = LooseJson(value).index(elements_.size())) {
        attributes[name] = *accessor;
      }
    }
    return attributes;
  }

  void lookAtAttribute(const std::string& name, std::size_t accessor, bool ofVertices) {
    uses_.useAccessor(accessor, GltfUse::vertices, pointer_);
    lookAtAlignment(accessor);
    const GltfAccessorShape& shape = elements_.shape(accessor);
    if (shape.componentType == kUnsignedInt) fault("an attribute of 32-bit integers");
    const LooseJson source = text_.list("accessors").at(accessor);
    if (name == "POSITION" && (!source["min"].exists() || !source["max"].exists())) {
      fault("positions without their least and largest");
    }
    if (name.starts_with('_')) return;
    const GltfSemantic* semantic = semanticOf(name);
    if (!semantic) return fault("an attribute of an unknown name");
    const bool type = shape.type == semantic->types[0] || shape.type == semantic->types[1] ||
                      (!ofVertices && name == "TANGENT" && shape.type == "VEC3");
    const bool moved = !ofVertices && semantic->isNumbered && shape.normalized;
    if (!type || !(isFormat(shape, semantic->formats) || (moved && isSmall(shape)))) {
      fault("an accessor of a type that does not fit its use");
    }
  }

  bool isFormat(const GltfAccessorShape& shape, std::string_view formats) const {
    const bool isUnsigned = shape.componentType == 5121 || shape.componentType == 5123;
    for (const char format : formats) {
      if (format == 'f' && shape.isFloat() && !shape.normalized) return true;
      if (format == 'n' && isUnsigned && shape.normalized) return true;
      if (format == 'u' && isUnsigned && !shape.normalized) return true;
      if (format == 'q' && quantized_ && isSmall(shape)) return true;
    }
    return false;
  }

  // Vertices lie at multiples of 4 bytes.
  void lookAtAlignment(std::size_t accessor) const {
    const LooseJson source = text_.list("accessors").at(accessor);
    const LooseJson views = text_.list("bufferViews");
    const LooseJson view = views.at(source["bufferView"].wholeOr(views.size()));
    const GltfAccessorShape& shape = elements_.shape(accessor);
    const std::uint64_t packed = gltfComponents(shape.type) * gltfBytesOf(shape.componentType);
    const std::uint64_t stride = view["byteStride"].wholeOr(packed);
    if (view.exists() && (source["byteOffset"].wholeOr(0) % 4 != 0 || stride % 4 != 0)) {
      fault("vertices that do not lie at multiples of 4 bytes");
    }
  }

  // Of one name they are numbered from 0.
  void lookAtSets(const Attributes& attributes) const {
    std::map<std::string_view, std::size_t> sets;
    for (const auto& [name, accessor] : attributes) {
      const GltfSemantic* semantic = semanticOf(name);
      if (semantic && semantic->isNumbered) ++sets[semantic->name];
    }
    for (const auto& [name, count] : sets) {
      if (!attributes.contains(std::string(name) + "_" + std::to_string(count - 1))) {
        fault("attributes that are not numbered from 0");
      }
    }
    if (sets["JOINTS"] != sets["WEIGHTS"]) fault("joints without weights, or the other way round");
  }

  void lookAtTargets(const LooseJson& targets, const Attributes& attributes) {
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const Attributes moved = attributesOf(targets.at(i));
      if (targets.at(i).isObject() && targets.at(i).json()->empty()) {
        fault("a morph target without attributes");
      }
      for (const auto& [name, accessor] : moved) {
        lookAtAttribute(name, accessor, false);
        const auto base = attributes.find(name);
        if (base == attributes.end()) {
          fault("a morph target of what the primitive does not have");
        } else if (elements_.shape(base->second).count != elements_.shape(accessor).count) {
          fault("attributes of different lengths");
        }
      }
    }
  }

  void lookAtIndices(const LooseJson& primitive, const Attributes& attributes) {
    const std::optional<std::size_t> indices = primitive["indices"].index(elements_.size());
    if (!indices) return;
    uses_.useAccessor(*indices, GltfUse::indices, pointer_ + "/indices");
    const GltfAccessorShape& shape = elements_.shape(*indices);
    const bool isUnsigned = shape.componentType == 5121 || shape.componentType == 5123 ||
                            shape.componentType == kUnsignedInt;
    if (shape.type != "SCALAR" || !isUnsigned || shape.normalized) {
      return fault("an accessor of a type that does not fit its use");
    }
    const auto position = attributes.find("POSITION");
    const GltfBounds& bounds = elements_.bounds(*indices);
    if (!bounds.known || position == attributes.end()) return;
    if (bounds.high[0] >= static_cast<double>(elements_.shape(position->second).count)) {
      fault("an index to a vertex that is not there");
    } else if (bounds.high[0] == gltfLargest(shape.componentType)) {
      fault("an index that means a new primitive");
    }
  }

  // It looks textures up with coordinates that the primitive has.
  void lookAtMaterial(const LooseJson& primitive, const Attributes& attributes) {
    const LooseJson material = text_.list("materials").at(primitive["material"].wholeOr(kNowhere));
    if (!material.isObject()) return;
    const auto [known, isNew] = setsOfMaterials_.try_emplace(material.json());
    if (isNew) addSets(*material.json(), known->second);
    for (const std::uint64_t set : known->second) {
      if (attributes.contains("TEXCOORD_" + std::to_string(set))) continue;
      fault("a texture with coordinates that the primitive does not have");
    }
  }

  // Those that its textures need, of which no real material has many.
  void addSets(const Json& value, std::set<std::uint64_t>& sets) const {
    constexpr std::size_t kMostSets = 16;
    for (const auto& [key, member] : value.items()) {
      if (!member.is_object() || key == "extras" || sets.size() >= kMostSets) continue;
      addSets(member, sets);
      const LooseJson texture(member);
      if (!key.ends_with("Texture") || !texture["index"].exists()) continue;
      const LooseJson moved = texture["extensions"]["KHR_texture_transform"]["texCoord"];
      sets.insert(moved.whole().value_or(texture["texCoord"].wholeOr(0)));
    }
  }

  void lookAtWeights(const LooseJson& mesh, const std::string& pointer) const {
    const LooseJson primitives = mesh["primitives"];
    const std::size_t targets = primitives.at(0)["targets"].size();
    for (std::size_t i = 1; i < primitives.size(); ++i) {
      if (primitives.at(i)["targets"].size() == targets) continue;
      text_.fault("primitives with different numbers of morph targets", pointer);
    }
    if (mesh["weights"].isList() && mesh["weights"].size() != targets) {
      text_.fault("another number of weights than of morph targets", pointer + "/weights");
    }
  }

  void lookAtSharedViews() const {
    const LooseJson views = text_.list("bufferViews");
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (uses_.sharers(i) < 2 || views.at(i)["byteStride"].exists()) continue;
      text_.fault("vertices of several accessors in a view without a stride",
                  pointerTo("bufferViews", i));
    }
  }

  static constexpr std::uint64_t kUnsignedInt = 5125, kNowhere = ~std::uint64_t{0};
  const GltfText& text_;
  const GltfElements& elements_;
  GltfUses& uses_;
  bool quantized_ = false;
  std::string pointer_;
  std::map<const Json*, std::set<std::uint64_t>> setsOfMaterials_;
};

}  // namespace

void countMeshFaults(const GltfText& text, const GltfElements& elements, GltfUses& uses) {
  MeshChecker(text, elements, uses).check();
}

}  // namespace whit
