#include "core/option_values.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "core/error.h"
#include "core/nearest_name.h"

namespace whit {

namespace {

[[noreturn]] void throwBadValue(const OptionSpec& spec, const std::string& text,
                                const std::string& expected) {
  throwUsage("--" + std::string(spec.name) + ": expected " + expected + ", got '" + text + "'");
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find(separator, begin)) != std::string::npos; begin = end + 1) {
    parts.push_back(text.substr(begin, end - begin));
  }
  parts.push_back(text.substr(begin));
  return parts;
}

// The whole text as a finite number.
template <typename T>
bool readNumber(const std::string& text, T& value) {
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end && std::isfinite(static_cast<double>(value));
}

// Exactly as many numbers as `values` holds.
template <typename T, std::size_t kCount>
bool readNumbers(const std::string& text, char separator, std::array<T, kCount>& values) {
  const std::vector<std::string> parts = split(text, separator);
  for (std::size_t i = 0; i < kCount; ++i) {
    if (parts.size() != kCount || !readNumber(parts[i], values[i])) return false;
  }
  return true;
}

template <typename T>
std::string shortest(T value) {
  char buffer[64];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return error == std::errc() ? std::string(buffer, end) : std::string();
}

std::string rangeText(const std::string& noun, const OptionSpec& spec) {
  const bool hasLow = spec.low > std::numeric_limits<double>::lowest();
  const bool hasHigh = spec.high < std::numeric_limits<double>::max();
  if (hasLow && hasHigh) return noun + " from " + shortest(spec.low) + " to " + shortest(spec.high);
  if (hasLow) return noun + " of at least " + shortest(spec.low);
  return noun;
}

template <typename T>
void parseNumber(const OptionSpec& spec, const std::string& text, const std::string& noun,
                 T& value) {
  T parsed{};
  if (!readNumber(text, parsed) || parsed < spec.low || parsed > spec.high) {
    throwBadValue(spec, text, rangeText(noun, spec));
  }
  value = parsed;
}

}  // namespace

std::vector<std::string> choicesOf(const OptionSpec& spec) {
  if (spec.words.find('|') == std::string_view::npos) return {};
  return split(std::string(spec.words), '|');
}

int parseChoice(const OptionSpec& spec, const std::string& text) {
  const std::vector<std::string> choices = choicesOf(spec);
  const auto found = std::find(choices.begin(), choices.end(), text);
  if (found == choices.end()) {
    throwUsage("--" + std::string(spec.name) + ": expected one of " + std::string(spec.words) +
               ", got '" + text + "'" + didYouMean(text, choices));
  }
  return static_cast<int>(found - choices.begin());
}

std::string choiceName(const OptionSpec& spec, int index) {
  return choicesOf(spec).at(static_cast<std::size_t>(index));
}

void parseValue(const OptionSpec& spec, const std::string& text, std::string& value) {
  if (!choicesOf(spec).empty()) parseChoice(spec, text);
  value = text;
}

void parseValue(const OptionSpec& spec, const std::string& text, bool& value) {
  if (text != "on" && text != "off" && text != "true" && text != "false") {
    throwBadValue(spec, text, "on or off");
  }
  value = text == "on" || text == "true";
}

void parseValue(const OptionSpec& spec, const std::string& text, int& value) {
  if (!choicesOf(spec).empty()) {
    parseChoice(spec, text);
    if (text == "auto") {
      value = 0;
      return;
    }
  }
  parseNumber(spec, text, "a whole number", value);
}

void parseValue(const OptionSpec& spec, const std::string& text, float& value) {
  parseNumber(spec, text, "a number", value);
}

void parseValue(const OptionSpec& spec, const std::string& text, double& value) {
  parseNumber(spec, text, "a number", value);
}

void parseValue(const OptionSpec& spec, const std::string& text, Exposure& value) {
  Exposure parsed{0, text == "auto"};
  if (!parsed.automatic) parseNumber(spec, text, "auto or a number", parsed.ev);
  value = parsed;
}

void parseValue(const OptionSpec& spec, const std::string& text, ImageSize& value) {
  std::array<int, 2> side{};
  const auto inRange = [](int s) { return s >= 1 && s <= kImageSideLimit; };
  if (!readNumbers(text, 'x', side) || !inRange(side[0]) || !inRange(side[1])) {
    throwBadValue(spec, text,
                  "WIDTHxHEIGHT in pixels, each from 1 to " + std::to_string(kImageSideLimit) +
                      ", as 1280x720");
  }
  value = {side[0], side[1]};
}

void parseValue(const OptionSpec& spec, const std::string& text, Crop& value) {
  std::array<int, 4> c{};
  const auto inOrder = [](int first, int end) {
    return first >= 0 && end > first && end <= kImageSideLimit;
  };
  if (!readNumbers(text, ',', c) || !inOrder(c[0], c[2]) || !inOrder(c[1], c[3])) {
    throwBadValue(spec, text, "x0,y0,x1,y1 in pixels with 0 <= x0 < x1 and 0 <= y0 < y1");
  }
  value = {c[0], c[1], c[2], c[3]};
}

void parseValue(const OptionSpec& spec, const std::string& text, Vec3f& value) {
  std::array<float, 3> v{};
  if (!readNumbers(text, ',', v)) {
    throwBadValue(spec, text, "three numbers x,y,z without blanks, as 0,1.5,-2");
  }
  value = {v[0], v[1], v[2]};
}

EffectSet parseEffects(const std::string& commaSeparated) {
  EffectSet set;
  for (const std::size_t i : indicesOf(commaSeparated, namesIn(kEffectNames), "effect")) {
    set = set.with(static_cast<Effect>(i));
  }
  return set;
}

void parseValue(const OptionSpec&, const std::string& text, EffectSet& value) {
  value = parseEffects(text);
}

void parseValue(const OptionSpec&, const std::string& text, ChannelSet& value) {
  value = parseChannels(text);
}

std::string formatValue(const OptionSpec&, const std::string& value) { return value; }
std::string formatValue(const OptionSpec&, bool value) { return value ? "on" : "off"; }
std::string formatValue(const OptionSpec& spec, int value) {
  return value == 0 && !choicesOf(spec).empty() ? "auto" : std::to_string(value);
}
std::string formatValue(const OptionSpec&, float value) { return shortest(value); }
std::string formatValue(const OptionSpec&, double value) { return shortest(value); }
std::string formatValue(const OptionSpec&, const Exposure& value) {
  return value.automatic ? "auto" : shortest(value.ev);
}
std::string formatValue(const OptionSpec&, const ImageSize& value) {
  return std::to_string(value.width) + "x" + std::to_string(value.height);
}
std::string formatValue(const OptionSpec&, const Crop& c) {
  return std::to_string(c.x0) + "," + std::to_string(c.y0) + "," + std::to_string(c.x1) + "," +
         std::to_string(c.y1);
}
std::string formatValue(const OptionSpec&, const Vec3f& v) {
  return shortest(v.x) + "," + shortest(v.y) + "," + shortest(v.z);
}

std::string formatValue(const OptionSpec&, const ChannelSet& value) { return namesOf(value); }

std::string formatValue(const OptionSpec&, const EffectSet& value) {
  std::string names;
  for (int i = 0; i < kEffectCount; ++i) {
    if (!value.has(static_cast<Effect>(i))) continue;
    if (!names.empty()) names += ',';
    names += kEffectNames[static_cast<std::size_t>(i)].name;
  }
  return names;
}

}  // namespace whit
