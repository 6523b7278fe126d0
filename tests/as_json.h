// JSON in tests is written with ' in place of ", which is easier to read in a literal.
#pragma once

#include <algorithm>
#include <string>

namespace whit {

inline std::string asJson(std::string json) {
  std::ranges::replace(json, '\'', '"');
  return json;
}

// Returns what a test saves under this name: only scenes and glTF files may have ' in place of ".
inline std::string savedText(const std::string& name, const std::string& text) {
  return name.ends_with(".json") || name.ends_with(".gltf") ? asJson(text) : text;
}

}  // namespace whit
