// Places in a glTF file that a pattern stands for: "meshes/*/primitives/*/+attributes", where * is
// every element of a list or every member of an object, and + says that the member is required.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include "io/scene/json_text.h"

namespace whit {

// Calls found(value, pointer) for each value at `path`, and missing(pointer, name) for each object
// that lacks a required member. `Value` is Json or const Json.
template <typename Value, typename Found, typename Missing>
void walkGltf(Value& value, std::string_view path, const std::string& pointer, Found&& found,
              Missing&& missing) {
  if (path.empty()) return found(value, pointer);
  const std::size_t end = std::min(path.find('/'), path.size());
  std::string_view name = path.substr(0, end);
  path.remove_prefix(std::min(end + 1, path.size()));
  if (name == "*") {
    if (value.is_array()) {
      for (std::size_t i = 0; i < value.size(); ++i) {
        walkGltf(value[i], path, pointer + "/" + std::to_string(i), found, missing);
      }
    } else if (value.is_object()) {
      for (auto member = value.begin(); member != value.end(); ++member) {
        walkGltf(*member, path, pointer + "/" + escapePointer(member.key()), found, missing);
      }
    }
    return;
  }
  const bool required = name.starts_with('+');
  if (required) name.remove_prefix(1);
  if (!value.is_object()) return;
  const auto member = value.find(std::string(name));
  if (member != value.end()) {
    walkGltf(*member, path, pointer + "/" + std::string(name), found, missing);
  } else if (required) {
    missing(pointer, std::string(name));
  }
}

}  // namespace whit
