// The table of what glTF's schemas say of each property that is read here.
#pragma once

#include <cstdint>
#include <span>

namespace whit {

enum class GltfKind { object, list, number, text, flag, whole, index, indices, vector };

struct GltfRule {
  const char* path;  // from the root; * is every element of a list or every member of an object
  GltfKind kind;
  std::uint64_t limit = 0;     // whole: the largest; vector: how many numbers
  const char* list = nullptr;  // index, indices: the path of the list they refer to
};

// Containers before what they contain. A + before the last name: the property is required.
std::span<const GltfRule> gltfRules();

// Wherever a material names a texture, and what it says of it there: paths from the place on.
std::span<const char* const> gltfTextureSlots();
std::span<const GltfRule> gltfTextureRules();

}  // namespace whit
