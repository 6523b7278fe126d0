// Extensions and their members, as tinygltf has them.
#pragma once

#include <tiny_gltf.h>

namespace whit {

// Null where there is none of this name.
inline const tinygltf::Value* findExtension(const tinygltf::ExtensionMap& extensions,
                                            const char* name) {
  const auto found = extensions.find(name);
  return found == extensions.end() ? nullptr : &found->second;
}

inline double numberOf(const tinygltf::Value& object, const char* key, double fallback) {
  return object.Has(key) ? object.Get(key).GetNumberAsDouble() : fallback;
}

}  // namespace whit
