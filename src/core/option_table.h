// The table of options in core/options.h by name, presets of its values, and the text form of every
// kind of value, both ways.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/options.h"
#include "core/text.h"

namespace whit {

// Says that no option has this name, with or without "--": with what the option is called here if
// other programs call it so, or with a near one of `names`.
std::string noOption(const std::string& name, const std::vector<std::string>& names);

// Set or format the option of this name. They throw Error(usage), which for an unknown name
// suggests a near one.
void setOption(RenderOptions& options, const std::string& name, const std::string& text);
std::string optionText(const RenderOptions& options, const std::string& name);

// Name and value of every option that can change the picture and says anything, in the order of the
// table.
std::vector<std::pair<std::string, std::string>> pictureOptions(const RenderOptions& options);

// The rebuild that a renderer with options `a` needs for frames with options `b`.
Rebuild rebuildNeeded(const RenderOptions& a, const RenderOptions& b);
// Copies the options that need no larger rebuild than `most`.
void takeOver(const RenderOptions& from, Rebuild most, RenderOptions& to);

// Applies the preset options.quality to all options but those named in `given`, which the user has
// set.
void applyQuality(RenderOptions& options, const std::set<std::string>& given);
// The options in which a preset differs from the defaults, as on the command line.
struct QualityPreset {
  std::string name, options;
};
std::vector<QualityPreset> qualityPresets();

// The options that a scene may state: they describe the picture, not how or where it is made.
std::vector<std::string> sceneOptionNames();
// Applies the options that a scene states, names and values as on the command line, except those in
// `given` and, if that has "quality", those of presets. A preset of the scene leaves `mode` alone.
void applySceneOptions(const std::map<std::string, std::string>& stated,
                       std::set<std::string> given, RenderOptions& options);

// The words between the bars of OptionSpec::words, with those in capitals that stand for a value;
// empty if there are no bars.
std::vector<std::string> choicesOf(const OptionSpec& spec);
// The index of `text` among them; throws Error(usage) that names the nearest one.
int parseChoice(const OptionSpec& spec, const std::string& text);

std::vector<std::string> split(const std::string& text, char separator);
std::vector<std::string> effectNames(EffectSet effects);
bool readBackground(const std::string& text, Background& value);
std::string backgroundText(const Background& background);
// "a number from 0 to 1", by the limits of the option.
std::string rangeText(const std::string& noun, const OptionSpec& spec);

// Reads the whole text as a finite number.
template <typename T>
bool readNumber(const std::string& text, T& value) {
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end && std::isfinite(static_cast<double>(value));
}

template <typename T>
std::string shortest(T value) {
  char buffer[64];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

template <typename T>
inline constexpr bool kIsOptional = false;
template <typename T>
inline constexpr bool kIsOptional<std::optional<T>> = true;

// Throws Error(usage) that names the option, the text and what was expected.
template <typename T>
void parseValue(const OptionSpec& spec, const std::string& text, T& value) {
  const auto expect = [&](bool good, const std::string& expected) {
    if (good) return;
    throwUsage("--" + std::string(spec.name) + ": expected " + expected + ", found '" + text + "'");
  };

  const auto parseNumber = [&](const std::string& noun, auto& number) {
    const bool read = readNumber(text, number);
    expect(read && number >= spec.low && number <= spec.high, rangeText(noun, spec));
  };

  const auto readAll = [&](char separator, auto&... numbers) {
    const std::vector<std::string> parts = split(text, separator);
    std::size_t i = 0;
    return parts.size() == sizeof...(numbers) && (readNumber(parts[i++], numbers) && ...);
  };

  T v{};
  if constexpr (kIsOptional<T>) {
    parseValue(spec, text, v.emplace());
  } else if constexpr (std::is_enum_v<T>) {
    v = static_cast<T>(parseChoice(spec, text));
  } else if constexpr (std::is_same_v<T, bool>) {
    expect(text == "on" || text == "off" || text == "true" || text == "false", "on or off");
    v = text == "on" || text == "true";
  } else if constexpr (std::is_arithmetic_v<T>) {
    const bool hasChoices = !choicesOf(spec).empty();
    if (hasChoices) parseChoice(spec, text);
    if (!hasChoices || text != "auto") {
      parseNumber(std::is_integral_v<T> ? "a whole number" : "a number", v);
    }
  } else if constexpr (std::is_same_v<T, Exposure>) {
    v.automatic = text == "auto";
    if (!v.automatic) parseNumber("auto or a number", v.ev);
  } else if constexpr (std::is_same_v<T, Background>) {
    expect(readBackground(text, v), "sky, transparent, white, black, or digits as ff8000 or #fff");
  } else if constexpr (std::is_same_v<T, ImageSize>) {
    expect(readAll('x', v.width, v.height) && std::min(v.width, v.height) >= 1 &&
               std::max(v.width, v.height) <= kImageSideLimit,
           concat("WIDTHxHEIGHT in pixels, each from 1 to ", kImageSideLimit, ", as 1280x720"));
  } else if constexpr (std::is_same_v<T, Crop>) {
    expect(readAll(',', v.x0, v.y0, v.x1, v.y1) && std::min(v.x0, v.y0) >= 0 && v.x0 < v.x1 &&
               v.y0 < v.y1 && std::max(v.x1, v.y1) <= kImageSideLimit,
           "x0,y0,x1,y1 in pixels with 0 <= x0 < x1 and 0 <= y0 < y1");
  } else if constexpr (std::is_same_v<T, Vec3f> || std::is_same_v<T, Vec3d>) {
    expect(readAll(',', v.x, v.y, v.z) && isFinite(Vec3f(v)),
           "three numbers x,y,z without blanks, as 0,1.5,-2");
  } else if constexpr (std::is_same_v<T, EffectSet>) {
    v = parseEffects(text);
  } else if constexpr (std::is_same_v<T, ChannelSet>) {
    v = parseChannels(text);
  } else {
    if (!choicesOf(spec).empty()) parseChoice(spec, text);
    v = text;
  }

  value = std::move(v);
}

// The inverse: parseValue(formatValue(v)) is v, bit for bit. Empty where there is nothing to say.
template <typename T>
std::string formatValue(const OptionSpec& spec, const T& v) {
  const auto numbersOf = [](const std::string& separator, auto first, auto... numbers) {
    return (shortest(first) + ... + (separator + shortest(numbers)));
  };

  if constexpr (kIsOptional<T>) {
    return v ? formatValue(spec, *v) : "";
  } else if constexpr (std::is_enum_v<T>) {
    return choicesOf(spec).at(static_cast<std::size_t>(v));
  } else if constexpr (std::is_same_v<T, bool>) {
    return v ? "on" : "off";
  } else if constexpr (std::is_integral_v<T>) {
    return v == 0 && !choicesOf(spec).empty() ? "auto" : shortest(v);
  } else if constexpr (std::is_floating_point_v<T>) {
    return shortest(v);
  } else if constexpr (std::is_same_v<T, Exposure>) {
    return v.automatic ? "auto" : shortest(v.ev);
  } else if constexpr (std::is_same_v<T, Background>) {
    return backgroundText(v);
  } else if constexpr (std::is_same_v<T, ImageSize>) {
    return numbersOf("x", v.width, v.height);
  } else if constexpr (std::is_same_v<T, Crop>) {
    return numbersOf(",", v.x0, v.y0, v.x1, v.y1);
  } else if constexpr (std::is_same_v<T, Vec3f> || std::is_same_v<T, Vec3d>) {
    return numbersOf(",", v.x, v.y, v.z);
  } else if constexpr (std::is_same_v<T, std::string>) {
    return v;
  } else if constexpr (std::is_same_v<T, EffectSet>) {
    return whit::joined(effectNames(v), ",");
  } else {
    return namesOf(v);
  }
}

}  // namespace whit
