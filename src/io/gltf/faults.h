// What a glTF file has that the specification forbids, but that can be shown all the same: each
// kind is counted as a warning. What cannot be shown is refused by who reads it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/warnings.h"
#include "io/gltf/loose_json.h"
#include "io/scene/json_text.h"

namespace whit {

class GltfElements;
class GltfUses;

// The file as far as it is read.
struct GltfText {
  const Json& root;
  const std::string& file;
  std::span<const std::string> buffers;  // their bytes
  Warnings& warnings;

  LooseJson list(std::string_view name) const { return LooseJson(root)[name]; }
  // `what` is a fixed phrase; "not valid glTF: " goes before it.
  void fault(const std::string& what, const std::string& pointer) const {
    warnings.add("not valid glTF: " + what, file + "#" + pointer);
  }
};

// "/list/index" + rest.
inline std::string pointerTo(std::string_view list, std::size_t index, std::string_view rest = "") {
  return "/" + std::string(list) + "/" + std::to_string(index) + std::string(rest);
}

// All of those below.
void countGltfFaults(const GltfText& text);

// Each property by itself: kind, range, length.
void countPropertyFaults(const GltfText& text);
// Which extensions are named, used and required.
void countExtensionFaults(const GltfText& text);
// Where bytes lie: buffers, views of them, accessors, images.
void countLayoutFaults(const GltfText& text, GltfUses& uses);
void countNodeFaults(const GltfText& text);
void countMeshFaults(const GltfText& text, const GltfElements& elements, GltfUses& uses);
void countSkinFaults(const GltfText& text, const GltfElements& elements, GltfUses& uses);
void countAnimationFaults(const GltfText& text, const GltfElements& elements, GltfUses& uses);
// What the accessors hold against what they say of it.
void countValueFaults(const GltfText& text, const GltfElements& elements);

}  // namespace whit
