#include "io/json_reader.h"

#include <cmath>
#include <unordered_set>

#include "core/error.h"
#include "core/index.h"
#include "core/option_table.h"
#include "io/files.h"

namespace whit {
namespace {

std::string inQuotes(const std::string& text) { return "\"" + text + "\""; }

// The pointer is cut, because a file may have keys of any length.
std::string placeInJson(const std::string& file, const std::string& pointer) {
  constexpr std::size_t kShown = 120;
  return file + "#" + (pointer.size() > kShown ? pointer.substr(0, kShown) + "..." : pointer);
}

// Errors about values that are no numbers at all do not mention a bound of kLargestNumber.
std::string rangeText(double low, double high, bool isNumber) {
  if (!isNumber && high >= kLargestNumber) {
    return low <= -kLargestNumber ? "a number" : formatted("a number not below %.9g", low);
  }
  return formatted("a number from %.9g to %.9g", low, high);
}

using Event = Json::parse_event_t;

// Refuses texts that the parser itself would accept: repeated keys, deep nesting, too many members.
class ParseGuard {
 public:
  explicit ParseGuard(std::string file) : file_(std::move(file)) {}

  bool operator()(Event event, const Json& parsed) {
    if (event == Event::object_start || event == Event::array_start) {
      if (levels_.size() >= kJsonDepthLimit) {
        fail(concat("nested deeper than ", kJsonDepthLimit, " levels"));
      }
      levels_.emplace_back();
    } else if (event == Event::key) {
      Level& level = levels_.back();
      level.key = parsed.get<std::string>();
      if (!level.keys.insert(level.key).second) fail("this key is given twice");
      if (level.keys.size() > kJsonMembersLimit) {
        fail(concat("more than ", kJsonMembersLimit, " members"));
      }
    } else {
      // The end of an object or a list completes a value of the level above.
      if (event != Event::value) levels_.pop_back();
      if (!levels_.empty()) ++levels_.back().index;
    }

    return true;
  }

  // Throws badScene with the place of the value that is being parsed.
  [[noreturn]] void fail(const std::string& what) const {
    std::string pointer;
    for (const Level& level : levels_) {
      const bool isArray = level.keys.empty();
      pointer += '/' + (isArray ? std::to_string(level.index) : escapePointer(level.key));
    }

    throwBadScene(placeInJson(file_, pointer), what);
  }

 private:
  struct Level {
    std::size_t index = 0;  // number of values that are complete
    std::string key;        // only in objects
    std::unordered_set<std::string> keys;
  };

  std::string file_;
  std::vector<Level> levels_;
};

std::string placeOfByte(const std::string& text, const std::string& file, std::size_t byte) {
  const std::size_t end = std::min(byte > 0 ? byte - 1 : 0, text.size());
  const auto line = std::count(text.begin(), text.begin() + end, '\n');
  const std::size_t lineStart = end == 0 ? std::string::npos : text.rfind('\n', end - 1);
  const std::size_t column = lineStart == std::string::npos ? end + 1 : end - lineStart;
  return concat(file, ":", line + 1, ":", column);
}

// Removes the library's own "[json.exception...] parse error at line ...: ", and the middle of a
// long text that it quotes.
std::string reason(std::string message) {
  constexpr std::size_t kShown = 120;
  const std::size_t colon = message.find(": ", message.find(", column "));
  if (colon != std::string::npos) message.erase(0, colon + 2);

  if (message.size() <= 2 * kShown) return message;
  return message.replace(kShown, message.size() - 2 * kShown, "...");
}

}  // namespace

Json parseJson(const std::string& text, const std::string& file) {
  ParseGuard guard(file);
  const auto watch = [&](int, Event event, const Json& parsed) { return guard(event, parsed); };

  try {
    return Json::parse(text, watch, /*allow_exceptions=*/true, /*ignore_comments=*/true);
  } catch (const Json::parse_error& error) {
    throwBadScene(placeOfByte(text, file, error.byte), reason(error.what()));
  } catch (const Json::out_of_range&) {  // thrown by the parser for such a number alone
    guard.fail("expected a number that a double can hold");
  }
}

std::string suggestion(const std::string& word, const std::vector<std::string>& names) {
  const std::string nearest = nearestName(word, names);
  return nearest.empty() ? "" : " (is " + inQuotes(excerpt(nearest)) + " meant?)";
}

std::string escapePointer(const std::string& token) {
  std::string result;
  for (const char c : token) {
    if (c == '~') {
      result += "~0";
    } else if (c == '/') {
      result += "~1";
    } else {
      result += c;
    }
  }
  return result;
}

std::string JsonValue::where() const { return placeInJson(document_->file, pointer_); }

void JsonValue::fail(const std::string& expected, std::string found) const {
  if (found.empty()) found = this->found();
  throwBadScene(where(), "expected " + expected + ", found " + found);
}

std::string JsonValue::found() const {
  if (!exists()) return "nothing";

  // Elements of structured values, and of long lists, are counted.
  constexpr std::size_t kShown = 8;
  const auto isStructured = [](const Json& element) { return element.is_structured(); };
  const bool isShort = value_->size() <= kShown && std::ranges::none_of(*value_, isStructured);
  if (isObject() || (isArray() && !isShort)) {
    return concat(std::string(isObject() ? "an object" : "a list"), " of ", value_->size());
  }
  return excerpt(value_->dump(-1, ' ', false, Json::error_handler_t::replace));
}

JsonValue JsonValue::child(const Json* value, const std::string& token) const {
  JsonValue result = *this;
  result.value_ = value;
  result.pointer_ += "/" + escapePointer(token);
  return result;
}

bool JsonValue::isNumber() const {
  return exists() && (value_->is_number() || (isText() && text().starts_with("$")));
}

// Evaluates "$name", "$name*0.5" or "$name/2".
double JsonValue::expression(const std::string& text) const {
  const std::size_t sign = std::min(text.find_first_of("*/"), text.size());
  const std::string name = text.substr(1, sign - 1);

  const auto parameter = document_->parameters.find(name);
  if (parameter == document_->parameters.end()) {
    std::vector<std::string> names;
    for (const auto& [known, value] : document_->parameters) names.push_back("$" + known);
    fail("a number or a parameter" + (names.empty() ? "; the scene has no parameters"
                                                    : suggestion(text.substr(0, sign), names)));
  }
  if (sign == text.size()) return parameter->second;

  double factor = 0;
  if (!readNumber(text.substr(sign + 1), factor)) {
    fail("a parameter such as \"$a\", \"$a*0.5\" or \"$a/2\"");
  }
  return text[sign] == '*' ? parameter->second * factor : parameter->second / factor;
}

double JsonValue::number(double low, double high) const {
  if (!isNumber()) fail(rangeText(low, high, false));
  double value = 0;
  if (isText()) {
    value = expression(value_->get_ref<const std::string&>());
  } else {
    value = value_->get<double>();
  }
  if (!(value >= low && value <= high)) fail(rangeText(low, high, true));
  return value;
}

int JsonValue::integer(int low, int high) const {
  const std::string expected =
      low == high ? std::to_string(low) : concat("a whole number from ", low, " to ", high);

  if (!isNumber()) fail(expected);
  double value = number();
  if (isText()) value = std::round(value);  // "$triangles/3" means the nearest
  if (!(value >= low && value <= high) || value != std::floor(value)) fail(expected);
  return static_cast<int>(value);
}

bool JsonValue::flag() const {
  if (!exists() || !value_->is_boolean()) fail("true or false");
  return value_->get<bool>();
}

std::string JsonValue::text() const {
  if (!isText()) fail("a string");
  return value_->get<std::string>();
}

std::string JsonValue::word(const std::vector<std::string>& choices) const {
  if (isText()) {
    std::string chosen = text();
    if (contains(choices, chosen)) return chosen;
  }

  const std::string list = inQuotes(joined(choices, "\", \""));
  if (choices.size() == 1) fail(list);
  fail("one of " + list + (isText() ? suggestion(text(), choices) : ""));
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
  std::vector<JsonValue> result;
  for (const auto i : indices(size())) result.push_back((*this)[i]);
  return result;
}

std::vector<JsonValue> JsonValue::elements(std::size_t count, const std::string& expected) const {
  if (!isArray() || value_->size() != count) fail(expected);
  return elements();
}

std::vector<std::pair<std::string, JsonValue>> JsonValue::members() const {
  std::vector<std::pair<std::string, JsonValue>> result;
  if (!exists()) return result;
  if (!isObject()) fail("an object");
  for (const auto& [key, value] : value_->items()) result.emplace_back(key, child(&value, key));
  return result;
}

JsonValue JsonValue::operator[](const std::string& name) const {
  if (exists() && !isObject()) fail("an object");

  const Json* value = nullptr;
  if (exists()) {
    const auto member = value_->find(name);
    if (member != value_->end()) value = &*member;
  }

  return child(value, name);
}

JsonValue JsonValue::need(const std::string& name) const {
  JsonValue member = (*this)[name];
  if (!member.exists()) throwBadScene(where(), "expected a member " + inQuotes(name));
  return member;
}

std::size_t JsonValue::size() const {
  if (exists() && !isArray()) fail("a list");
  return exists() ? value_->size() : 0;
}

JsonValue JsonValue::operator[](std::size_t i) const {
  return child(i < size() ? &(*value_)[i] : nullptr, std::to_string(i));
}

double JsonValue::numberOr(double fallback) const {
  if (!exists()) return fallback;
  if (!value_->is_number()) fail("a number");
  return value_->get<double>();
}

std::optional<std::uint64_t> JsonValue::whole() const {
  if (value_->is_number_unsigned()) return value_->get<std::uint64_t>();

  // Some writers store whole numbers as 1.0 or 1e0.
  const double number = value_->is_number() ? value_->get<double>() : -1;
  const bool fits = number >= 0 && number <= static_cast<double>(kLargestJsonWhole) &&
                    number == std::floor(number);
  return fits ? std::optional(static_cast<std::uint64_t>(number)) : std::nullopt;
}

std::uint64_t JsonValue::wholeOr(std::uint64_t fallback, std::uint64_t limit) const {
  if (!exists()) return fallback;
  const std::optional<std::uint64_t> number = whole();
  if (!number || *number > limit) fail(concat("a whole number from 0 to ", limit));
  return *number;
}

std::vector<double> JsonValue::numbers() const {
  std::vector<double> all(size());
  for (const auto i : indices(all)) all[i] = (*this)[i].numberOr(0);
  return all;
}

std::vector<double> JsonValue::numbers(std::size_t count) const {
  if (!exists()) return {};
  if (!isArray() || size() != count) fail(concat(count, " numbers"));
  return numbers();
}

std::optional<std::size_t> JsonValue::indexInto(const JsonValue& list) const {
  if (!exists()) return std::nullopt;

  const std::size_t size = list.size();
  const std::string expected =
      "an index into " + list.pointer_.substr(list.pointer_.rfind('/') + 1);
  if (size == 0) fail(expected + ", which has no elements");

  const std::optional<std::uint64_t> number = whole();
  if (!number || *number >= size) fail(concat(expected, ", from 0 to ", size - 1));
  return *number;
}

JsonObject::JsonObject(const JsonValue& value) : value_(value) {
  if (!value.isObject()) value.fail("an object");
}

JsonValue JsonObject::find(const std::string& key) {
  if (!contains(known_, key)) known_.push_back(key);
  return value_[key];
}

JsonValue JsonObject::need(const std::string& key) {
  if (JsonValue value = find(key)) return value;

  // The error suggests a similar key among those that have not been read.
  std::vector<std::string> others;
  for (const auto& [name, member] : value_.members()) {
    if (!contains(known_, name)) others.push_back(name);
  }

  const std::string meant = nearestName(key, others);
  throwBadScene(value_.where(),
                "expected a member " + inQuotes(key) +
                    (meant.empty() ? "" : ", there is " + inQuotes(excerpt(meant))));
}

float JsonObject::number(const std::string& key, double fallback, double low, double high) {
  const JsonValue value = find(key);
  return static_cast<float>(value ? value.number(low, high) : fallback);
}

void JsonObject::finish() const {
  for (const auto& [key, value] : value_.members()) {
    if (contains(known_, key)) continue;
    throwBadScene(value.where(), "unknown key" + suggestion(key, known_));
  }
}

}  // namespace whit
