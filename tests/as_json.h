// JSON in tests is written with ' in place of ", which is easier to read in a literal.
#pragma once

#include <algorithm>
#include <string>

namespace whit {

inline std::string asJson(std::string json) {
  std::ranges::replace(json, '\'', '"');
  return json;
}

}  // namespace whit
