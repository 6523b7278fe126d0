// The text form of every kind of option value, both ways.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/options.h"

namespace whit {

// Each throws Error(usage) that names the option, the text and what was expected.
void parseValue(const OptionSpec& spec, const std::string& text, std::string& value);
void parseValue(const OptionSpec& spec, const std::string& text, bool& value);
void parseValue(const OptionSpec& spec, const std::string& text, int& value);
void parseValue(const OptionSpec& spec, const std::string& text, float& value);
void parseValue(const OptionSpec& spec, const std::string& text, double& value);
void parseValue(const OptionSpec& spec, const std::string& text, Exposure& value);
void parseValue(const OptionSpec& spec, const std::string& text, ImageSize& value);
void parseValue(const OptionSpec& spec, const std::string& text, Crop& value);
void parseValue(const OptionSpec& spec, const std::string& text, Vec3f& value);
void parseValue(const OptionSpec& spec, const std::string& text, EffectSet& value);
void parseValue(const OptionSpec& spec, const std::string& text, ChannelSet& value);

// The words that an option takes; none if it takes others than those.
std::vector<std::string> choicesOf(const OptionSpec& spec);
// Which of them `text` is; throws naming the nearest one.
int parseChoice(const OptionSpec& spec, const std::string& text);
std::string choiceName(const OptionSpec& spec, int index);

// The inverse: parseValue(formatValue(v)) is v, bit for bit. Empty where there is nothing to say.
std::string formatValue(const OptionSpec& spec, const std::string& value);
std::string formatValue(const OptionSpec& spec, bool value);
std::string formatValue(const OptionSpec& spec, int value);
std::string formatValue(const OptionSpec& spec, float value);
std::string formatValue(const OptionSpec& spec, double value);
std::string formatValue(const OptionSpec& spec, const Exposure& value);
std::string formatValue(const OptionSpec& spec, const ImageSize& value);
std::string formatValue(const OptionSpec& spec, const Crop& value);
std::string formatValue(const OptionSpec& spec, const Vec3f& value);
std::string formatValue(const OptionSpec& spec, const EffectSet& value);
std::string formatValue(const OptionSpec& spec, const ChannelSet& value);

template <typename Enum>
requires std::is_enum_v<Enum>
void parseValue(const OptionSpec& spec, const std::string& text, Enum& value) {
  value = static_cast<Enum>(parseChoice(spec, text));
}
template <typename Enum>
requires std::is_enum_v<Enum> std::string formatValue(const OptionSpec& spec, Enum value) {
  return choiceName(spec, static_cast<int>(value));
}

template <typename T>
void parseValue(const OptionSpec& spec, const std::string& text, std::optional<T>& value) {
  T parsed{};
  parseValue(spec, text, parsed);
  value = parsed;
}
template <typename T>
std::string formatValue(const OptionSpec& spec, const std::optional<T>& value) {
  return value ? formatValue(spec, *value) : std::string();
}

}  // namespace whit
