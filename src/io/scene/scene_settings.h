// Members of a scene's description that are given apart from its file: --set POINTER=VALUE.
#pragma once

#include <string>
#include <vector>

#include "io/json_reader.h"

namespace whit {

// A JSON pointer (RFC 6901) taken apart, and the value that is to stand there.
struct SceneSetting {
  std::vector<std::string> tokens;  // at least one
  Json value;
};

// "/lights/0/intensity=40". The value is everything after the first '=' that JSON follows, for
// names may hold that sign as well. Throws Error(usage).
SceneSetting parseSceneSetting(const std::string& text);

// Adds one to settings that are taken in their order, in place of those that it leaves nothing of:
// a member that is set again and again is one setting.
void addSceneSetting(const std::string& text, std::vector<std::string>& settings);

// Puts the value into the description, whatever was there; objects that lead to it are made
// where there are none, and "-" stands for a new element of a list. Whether such a member makes
// sense is for the reader of the scene to say. Throws badScene with "file#/json/pointer".
void applySceneSetting(const SceneSetting& setting, JsonDocument& document);

}  // namespace whit
