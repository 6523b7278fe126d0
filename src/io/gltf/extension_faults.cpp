// Extensions have to be declared before they are used or required, and have their places.
#include <array>
#include <set>

#include "io/gltf/faults.h"

namespace whit {
namespace {

// Where pointers to objects have to begin that hold extensions of these names.
struct GltfExtensionPlace {
  std::string_view beginning, place, other;
};
constexpr std::array<GltfExtensionPlace, 3> kPlaces = {{
    {"KHR_materials_", "/materials/", "/materials/"},
    {"KHR_lights_punctual", "/nodes/", "/extensions"},
    {"KHR_texture_transform", "/materials/", "/materials/"},
}};

class ExtensionChecker {
 public:
  explicit ExtensionChecker(const GltfText& text) : text_(text) {
    const LooseJson used = text.list("extensionsUsed");
    for (std::size_t i = 0; i < used.size(); ++i) declared_.insert(std::string(used.at(i).text()));
  }

  void check() {
    walk(text_.root, "");
    const LooseJson required = text_.list("extensionsRequired");
    std::set<std::string_view> needed;
    for (std::size_t i = 0; i < required.size(); ++i) {
      const std::string name(required.at(i).text());
      if (!declared_.contains(name)) {
        text_.fault("an extension is required and not declared", "/extensionsRequired");
      }
      needed.insert(required.at(i).text());
    }
    constexpr char kQuantization[] = "KHR_mesh_quantization";
    if (declared_.contains(kQuantization) && !needed.contains(kQuantization)) {
      text_.fault("an extension that has to be required is not", "/extensionsUsed");
    }
  }

 private:
  // The depth is bounded by parseJson().
  void walk(const Json& value, const std::string& pointer) {
    if (!value.is_structured()) return;
    if (value.is_array()) {
      for (std::size_t i = 0; i < value.size() && value[i].is_structured(); ++i) {
        walk(value[i], pointer + "/" + std::to_string(i));
      }
      return;
    }
    for (const auto& [key, member] : value.items()) {
      if (key == "extensions" && member.is_object()) look(member, pointer + "/extensions");
      if (key != "extras") walk(member, pointer + "/" + escapePointer(key));
    }
  }

  void look(const Json& extensions, const std::string& pointer) {
    for (const auto& [name, value] : extensions.items()) {
      const std::string at = pointer + "/" + escapePointer(name);
      if (!declared_.contains(name)) text_.fault("an extension is used and not declared", at);
      if (!value.is_object()) text_.fault("a property of another kind than it has to be", at);
      for (const GltfExtensionPlace& known : kPlaces) {
        if (!name.starts_with(known.beginning) || at.starts_with(known.place)) continue;
        if (name == "KHR_materials_variants") continue;  // which meshes choose from
        if (!at.starts_with(known.other)) text_.fault("an extension where it has no place", at);
      }
    }
  }

  const GltfText& text_;
  std::set<std::string> declared_;
};

}  // namespace

void countExtensionFaults(const GltfText& text) { ExtensionChecker(text).check(); }

}  // namespace whit
