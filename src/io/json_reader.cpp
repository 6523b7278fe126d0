#include "io/json_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core/error.h"
#include "core/nearest_name.h"

namespace whit {
namespace {

std::string inQuotes(const std::string& text) { return "\"" + text + "\""; }

std::string printed(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.9g", x);
  return buffer;
}

// Asked of what is no number, where a bound that no scene comes near would only be noise.
std::string kindText(double low, double high) {
  if (low <= -kLargestNumber && high >= kLargestNumber) return "a number";
  if (high >= kLargestNumber) return "a number not below " + printed(low);
  return "a number from " + printed(low) + " to " + printed(high);
}

// Asked of a number that is out of range: both bounds, whichever it is beyond.
std::string rangeText(double low, double high) {
  return "a number from " + printed(low) + " to " + printed(high);
}

}  // namespace

void JsonValue::fail(const std::string& expected) const {
  throwBadScene(where(), "expected " + expected + ", found " + found());
}

std::string JsonValue::found() const {
  constexpr std::size_t kShown = 60;
  if (isObject() || isArray()) {
    return std::string(isObject() ? "an object" : "a list") + " of " +
           std::to_string(value_->size());
  }
  std::string text = value_->dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > kShown) text = text.substr(0, kShown) + "...";
  return text;
}

JsonValue JsonValue::child(const Json& value, const std::string& token) const {
  return {*document_, value, pointer_ + "/" + escapePointer(token)};
}

bool JsonValue::isNumber() const {
  return value_->is_number() || (isText() && text().starts_with("$"));
}

// "$name", "$name*0.5", "$name/2".
double JsonValue::expression(const std::string& text) const {
  const std::size_t sign = std::min(text.find_first_of("*/"), text.size());
  const std::string name = text.substr(1, sign - 1);
  const auto parameter = document_->parameters.find(name);
  if (parameter == document_->parameters.end()) {
    std::vector<std::string> names;
    for (const auto& [known, value] : document_->parameters) names.push_back(known);
    const std::string nearest = nearestName(name, names);
    std::string more = names.empty() ? "; the scene has no parameters" : "";
    if (!nearest.empty()) more = " (is " + inQuotes("$" + nearest) + " meant?)";
    fail("a number or a parameter" + more);
  }
  if (sign == text.size()) return parameter->second;
  char* rest = nullptr;
  const std::string factorText = text.substr(sign + 1);
  const double factor = std::strtod(factorText.c_str(), &rest);
  if (factorText.empty() || *rest != '\0') {
    fail("\"$" + name + "\", \"$" + name + "*0.5\" or \"$" + name + "/2\"");
  }
  return text[sign] == '*' ? parameter->second * factor : parameter->second / factor;
}

double JsonValue::number(double low, double high) const {
  if (!isNumber()) fail(kindText(low, high));
  const double value =
      isText() ? expression(value_->get_ref<const std::string&>()) : value_->get<double>();
  if (!(value >= low && value <= high)) fail(rangeText(low, high));
  return value;
}

int JsonValue::integer(int low, int high) const {
  const std::string expected =
      low == high ? std::to_string(low)
                  : "a whole number from " + std::to_string(low) + " to " + std::to_string(high);
  if (!isNumber()) fail(expected);
  double value = number();
  if (isText()) value = std::round(value);  // "$triangles/3" means the nearest
  if (!(value >= low && value <= high) || value != std::floor(value)) fail(expected);
  return static_cast<int>(value);
}

bool JsonValue::flag() const {
  if (!value_->is_boolean()) fail("true or false");
  return value_->get<bool>();
}

std::string JsonValue::text() const {
  if (!isText()) fail("a string");
  return value_->get<std::string>();
}

std::string JsonValue::word(const std::vector<std::string>& choices) const {
  if (isText()) {
    std::string chosen = text();
    if (std::find(choices.begin(), choices.end(), chosen) != choices.end()) return chosen;
  }
  std::string list;
  for (const std::string& choice : choices) list += (list.empty() ? "" : ", ") + inQuotes(choice);
  std::string nearest = isText() ? nearestName(text(), choices) : "";
  if (!nearest.empty()) nearest = " (is " + inQuotes(nearest) + " meant?)";
  fail("one of " + list + nearest);
}

Vec3d JsonValue::vector() const {
  const std::vector<JsonValue> e = elements(3, "three numbers [x, y, z]");
  return {e[0].number(), e[1].number(), e[2].number()};
}

Rgb JsonValue::color(double high) const {
  if (isNumber()) return Rgb(static_cast<float>(number(0, high)));
  const std::vector<JsonValue> e = elements(3, "a color [r, g, b] or a number");
  return Rgb(Vec3d{e[0].number(0, high), e[1].number(0, high), e[2].number(0, high)});
}

std::vector<JsonValue> JsonValue::elements() const {
  if (!isArray()) fail("a list");
  std::vector<JsonValue> result;
  result.reserve(value_->size());
  for (std::size_t i = 0; i < value_->size(); ++i) {
    result.push_back(child((*value_)[i], std::to_string(i)));
  }
  return result;
}

std::vector<JsonValue> JsonValue::elements(std::size_t count, const std::string& expected) const {
  if (!isArray() || value_->size() != count) fail(expected);
  return elements();
}

std::vector<std::pair<std::string, JsonValue>> JsonValue::members() const {
  if (!isObject()) fail("an object");
  std::vector<std::pair<std::string, JsonValue>> result;
  for (const auto& [key, value] : value_->items()) result.emplace_back(key, child(value, key));
  return result;
}

JsonObject::JsonObject(const JsonValue& value) : value_(value) {
  if (!value.isObject()) value.fail("an object");
}

std::optional<JsonValue> JsonObject::find(const std::string& key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  const auto member = value_.value_->find(key);
  if (member == value_.value_->end()) return std::nullopt;
  return value_.child(*member, key);
}

JsonValue JsonObject::need(const std::string& key) {
  if (const auto value = find(key)) return *value;
  std::vector<std::string> others;
  for (const auto& [name, member] : value_.members()) {
    if (std::find(known_.begin(), known_.end(), name) == known_.end()) others.push_back(name);
  }
  const std::string meant = nearestName(key, others);
  throwBadScene(value_.where(), "expected a member " + inQuotes(key) +
                                    (meant.empty() ? "" : ", there is " + inQuotes(meant)));
}

float JsonObject::number(const std::string& key, double fallback, double low, double high) {
  const auto value = find(key);
  return static_cast<float>(value ? value->number(low, high) : fallback);
}

void JsonObject::finish() const {
  for (const auto& [key, value] : value_.members()) {
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    const std::string nearest = nearestName(key, known_);
    throwBadScene(value.where(),
                  "unknown key" +
                      (nearest.empty() ? std::string() : "; is " + inQuotes(nearest) + " meant?"));
  }
}

}  // namespace whit
