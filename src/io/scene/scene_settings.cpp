#include "io/scene/scene_settings.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "core/error.h"

namespace whit {
namespace {

// Empty unless `text` is a pointer to something inside.
std::vector<std::string> tokensOf(const std::string& text) {
  std::vector<std::string> tokens;
  try {
    for (Json::json_pointer rest(text); !rest.empty(); rest.pop_back()) {
      tokens.push_back(rest.back());
    }
  } catch (const Json::parse_error&) {
    return {};
  }
  std::reverse(tokens.begin(), tokens.end());
  return tokens;
}

// The index of an element of `list`, or of a new element.
std::size_t indexOf(const std::string& token, const Json& list, const JsonValue& place) {
  if (token == "-") return list.size();
  std::size_t index = 0;
  const char* const end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, index);
  const bool plain = error == std::errc() && stop == end && (token[0] != '0' || token.size() == 1);
  if (!plain || index >= list.size()) {
    place.fail("an index below " + std::to_string(list.size()) + ", or - for a new element");
  }
  return index;
}

// True if one of the members is within the other, or both are the same.
bool areRelated(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  return std::equal(
      a.begin(), a.begin() + static_cast<std::ptrdiff_t>(std::min(a.size(), b.size())), b.begin());
}

}  // namespace

SceneSetting parseSceneSetting(const std::string& text) {
  const std::string wanted =
      "'--set " + text + "': expected POINTER=VALUE, a JSON pointer into the scene and a value, " +
      "as in /lights/0/intensity=40 or '/sky/image=\"a.hdr\"'";
  for (std::size_t sign = text.find('='); sign != std::string::npos;
       sign = text.find('=', sign + 1)) {
    const std::string pointer = text.substr(0, sign), value = text.substr(sign + 1);
    if (!Json::accept(value)) continue;
    SceneSetting setting{tokensOf(pointer), parseJson(value, "--set " + pointer)};
    if (setting.tokens.empty()) throwUsage(wanted);
    if (setting.tokens.size() > kJsonDepthLimit) {
      throwUsage(wanted + ", of at most " + std::to_string(kJsonDepthLimit) + " steps");
    }
    return setting;
  }
  throwUsage(wanted);
}

// The last of those that have to do with the member can go if it is of that very member: the ones
// after it could as well come before it.
void addSceneSetting(const std::string& text, std::vector<std::string>& settings) {
  const std::vector<std::string> tokens = parseSceneSetting(text).tokens;
  const std::string section = "/" + escapePointer(tokens.front());
  const bool appends = std::find(tokens.begin(), tokens.end(), "-") != tokens.end();
  for (std::size_t i = settings.size(); i-- > 0 && !appends;) {
    if (!settings[i].starts_with(section)) continue;
    const std::vector<std::string> other = parseSceneSetting(settings[i]).tokens;
    if (!areRelated(tokens, other)) continue;
    if (tokens == other) settings.erase(settings.begin() + static_cast<std::ptrdiff_t>(i));
    break;
  }
  settings.push_back(text);
}

void applySceneSetting(const SceneSetting& setting, JsonDocument& document) {
  Json* at = &document.root;
  std::string pointer;
  for (const std::string& token : setting.tokens) {
    if (at->is_null()) *at = Json::object();  // made by the step before
    const std::string parent = std::exchange(pointer, pointer + "/" + escapePointer(token));
    if (at->is_object()) {
      at = &(*at)[token];
    } else if (at->is_array()) {
      const std::size_t index = indexOf(token, *at, JsonValue(document, *at, pointer));
      if (index == at->size()) at->push_back(nullptr);
      at = &(*at)[index];
    } else {
      JsonValue(document, *at, parent).fail("an object or a list");
    }
  }
  *at = setting.value;
}

}  // namespace whit
