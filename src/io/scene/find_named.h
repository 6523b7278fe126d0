// Things of a scene by their names.
#pragma once

#include <string>
#include <vector>

#include "core/nearest_name.h"
#include "io/json_reader.h"

namespace whit {

// The one that the text of `name` stands for; an error names the nearest. `kind` has an article:
// "a material".
template <typename Entries>
typename Entries::const_iterator findNamed(const Entries& entries, const JsonValue& name,
                                           const std::string& kind) {
  const auto found = entries.find(name.text());
  if (found != entries.end()) return found;
  std::vector<std::string> names;
  names.reserve(entries.size());
  for (const auto& [known, entry] : entries) names.push_back(known);
  const std::string nearest = nearestName(name.text(), names);
  name.fail("the name of " + kind +
            (nearest.empty() ? std::string() : " (is \"" + nearest + "\" meant?)"));
}

}  // namespace whit
