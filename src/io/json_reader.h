// Parses and reads JSON files. Every value knows its place in the file, so that errors name it, and
// a JsonObject knows which of its keys were read, so that misspelt keys do not go unnoticed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/text.h"
#include "core/vec3.h"
#include "scene/members.h"

namespace whit {

using Json = nlohmann::ordered_json;  // members keep the file's order

inline constexpr int kJsonDepthLimit = 64;
inline constexpr std::size_t kJsonMembersLimit = 4096;  // members are looked up one by one
inline constexpr std::uint64_t kJsonBytesLimit = 16u << 20;
// Whole numbers up to this are exact in JSON.
inline constexpr std::uint64_t kLargestJsonWhole = std::uint64_t{1} << 53;

// Parses JSON, in which comments are allowed. Throws badScene with "file:line:column" for a syntax
// error, with "file#/pointer" for a key that is given twice, nesting deeper than kJsonDepthLimit or
// a number beyond double.
Json parseJson(const std::string& text, const std::string& file);

// Returns " (is "NAME" meant?)" for the end of an error message, or an empty text if no name is
// near.
std::string suggestion(const std::string& word, const std::vector<std::string>& names);

// Returns `token` as a part of a JSON pointer (RFC 6901, section 3).
std::string escapePointer(const std::string& token);

// The data that all values of one file share. Numbers may be written "$name", "$name*0.5" or
// "$name/2", with a parameter's name.
struct JsonDocument {  // NOLINT(bugprone-exception-escape): moving Json does not throw
  std::string file;
  Json root;
  std::map<std::string, double> parameters;
};

// A member or element that the file does not have is a value that does not exist. It has no members
// and no elements; the functions with "Or" return their fallback for it, and those that need a
// value fail.
class JsonValue {
 public:
  explicit JsonValue(const JsonDocument& document) : JsonValue(document, document.root, "") {}
  JsonValue(const JsonDocument& document, const Json& value, std::string pointer)
      : document_(&document), value_(&value), pointer_(std::move(pointer)) {}

  const std::string& pointer() const { return pointer_; }  // into the file, RFC 6901
  std::string where() const;                               // for errors: "file#/json/pointer"

  // Without `found`, the error says what the value is.
  [[noreturn]] void fail(const std::string& expected, std::string found = "") const;

  bool exists() const { return value_ != nullptr; }
  explicit operator bool() const { return exists(); }
  bool isObject() const { return exists() && value_->is_object(); }
  bool isArray() const { return exists() && value_->is_array(); }
  bool isNull() const { return exists() && value_->is_null(); }
  bool isText() const { return exists() && value_->is_string(); }
  bool isNumber() const;  // a number, or a string that stands for one

  // Each of these fails unless the value is of that kind and in the (closed) range.
  double number(double low = -kLargestNumber, double high = kLargestNumber) const;
  int integer(int low, int high) const;
  bool flag() const;
  std::string text() const;

  // Returns one of `choices`; the error suggests the nearest.
  std::string word(const std::vector<std::string>& choices) const;
  Vec3d vector() const;
  Rgb color(double high = kLargestNumber) const;  // [r, g, b] or one number, at least 0
  std::vector<JsonValue> elements() const;
  std::vector<JsonValue> elements(std::size_t count, const std::string& expected) const;

  // Returns the members in the file's order.
  std::vector<std::pair<std::string, JsonValue>> members() const;

  JsonValue operator[](const std::string& name) const;
  JsonValue operator[](std::size_t i) const;
  JsonValue need(const std::string& name) const;  // fails where the member is missing
  std::size_t size() const;                       // number of elements of a list
  double numberOr(double fallback) const;

  // Accepts 1e0 and 1.0 as well as 1.
  std::uint64_t wholeOr(std::uint64_t fallback, std::uint64_t limit = kLargestJsonWhole) const;
  bool flagOr(bool fallback) const { return exists() ? flag() : fallback; }
  std::string textOr(const std::string& fallback) const { return exists() ? text() : fallback; }

  // Both lists are empty where the value does not exist.
  std::vector<double> numbers() const;
  std::vector<double> numbers(std::size_t count) const;

  // Returns the value as an index into `list`, or nothing where it does not exist.
  std::optional<std::size_t> indexInto(const JsonValue& list) const;

 private:
  friend class JsonObject;
  JsonValue child(const Json* value, const std::string& token) const;
  std::optional<std::uint64_t> whole() const;
  double expression(const std::string& text) const;
  std::string found() const;

  const JsonDocument* document_;
  const Json* value_;  // null where it does not exist
  std::string pointer_;
};

class JsonObject {
 public:
  explicit JsonObject(const JsonValue& value);  // fails unless an object

  const JsonValue& value() const { return value_; }
  bool has(const std::string& key) { return find(key).exists(); }
  JsonValue find(const std::string& key);  // does not exist where the key is missing
  JsonValue need(const std::string& key);

  float number(const std::string& key, double fallback, double low = -kLargestNumber,
               double high = kLargestNumber);

  // Fails at a key that was never read; the error suggests the nearest one that was.
  void finish() const;

 private:
  JsonValue value_;
  std::vector<std::string> known_;
};

// Finds the entry that `name` names; an error suggests the nearest. `kind` has an article: "a
// material".
template <typename Entries>
typename Entries::const_iterator findNamed(const Entries& entries, const JsonValue& name,
                                           const std::string& kind) {
  const auto found = entries.find(name.text());
  if (found != entries.end()) return found;

  name.fail("the name of " + kind + suggestion(name.text(), keysOf(entries)));
}

template <typename Noun, typename Value>
void readMember(const JsonValue& json, const Member<Noun, Value>& member, Value& value) {
  const MemberRules<Noun>& rules = member.rules;

  if constexpr (std::is_same_v<Value, bool>) {
    value = json.flag();
  } else if constexpr (std::is_integral_v<Value>) {
    value = json.integer(static_cast<int>(rules.low), static_cast<int>(rules.high));
  } else if constexpr (std::is_same_v<Value, Vec3f>) {
    value = rules.kind == MemberKind::color ? json.color(rules.high) : Vec3f(json.vector());
  } else if constexpr (std::is_enum_v<Value>) {
    constexpr auto& kNames = kWords<Value>;
    const auto* const found = std::ranges::find(kNames, json.word({kNames.begin(), kNames.end()}));
    value = static_cast<Value>(found - kNames.begin());
  } else if constexpr (std::is_same_v<Value, std::vector<float>>) {
    value.clear();
    for (const JsonValue& element : json.elements()) {
      value.push_back(static_cast<float>(element.number(rules.low, rules.high)));
    }
  } else {
    value = static_cast<Value>(json.number(rules.low, rules.high));
  }
}

// Reads the members that the object gives, except maps; the others keep their values.
template <typename Noun>
void readMembers(JsonObject& object, Noun& noun) {
  forEachMemberInFiles(noun, [&](const auto& member) {
    const JsonValue json = object.find(member.name);
    if (!json && member.rules.required) object.need(member.name);
    if (json) readMember(json, member, noun.*member.field);
  });
}

}  // namespace whit
