#include "core/option_values.h"

#include <sstream>

#include "core/formatted.h"
#include "core/nearest_name.h"

namespace whit {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text + separator);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

bool readBackground(const std::string& text, Background& value) {
  using Kind = Background::Kind;
  value.kind = text == "sky" ? Kind::sky : text == "transparent" ? Kind::transparent : Kind::color;
  if (value.kind != Kind::color) return true;
  std::string digits = text.substr(text.starts_with('#') ? 1 : 0);
  if (text == "white" || text == "black") digits = text == "white" ? "ffffff" : "000000";
  for (std::size_t i = 0; i < 3 && digits.size() == 6; ++i) {
    const char* const first = digits.data() + 2 * i;
    const auto [stop, error] = std::from_chars(first, first + 2, value.color[i], 16);
    if (error != std::errc() || stop != first + 2) return false;
  }
  return digits.size() == 6;
}

std::string backgroundText(const Background& b) {
  if (b.kind == Background::Kind::color) {
    return formatted("%02x%02x%02x", b.color[0], b.color[1], b.color[2]);
  }
  return b.kind == Background::Kind::sky ? "sky" : "transparent";
}

std::string rangeText(const std::string& noun, const OptionSpec& spec) {
  const bool hasLow = spec.low > std::numeric_limits<double>::lowest();
  const bool hasHigh = spec.high < std::numeric_limits<double>::max();
  if (hasLow && hasHigh) return noun + " from " + shortest(spec.low) + " to " + shortest(spec.high);
  if (hasLow) return noun + " of at least " + shortest(spec.low);
  return noun;
}

std::vector<std::string> choicesOf(const OptionSpec& spec) {
  if (spec.words.find('|') == std::string_view::npos) return {};
  return split(std::string(spec.words), '|');
}

int parseChoice(const OptionSpec& spec, const std::string& text) {
  const std::vector<std::string> choices = choicesOf(spec);
  const auto found = std::ranges::find(choices, text);
  if (found == choices.end()) {
    throwUsage("--" + std::string(spec.name) + ": expected one of " + std::string(spec.words) +
               ", found '" + text + "'" + didYouMean(text, choices));
  }
  return static_cast<int>(found - choices.begin());
}

EffectSet parseEffects(const std::string& commaSeparated) {
  EffectSet set;
  for (const std::size_t i : indicesOf(commaSeparated, namesIn(kEffectNames), "effect")) {
    set = set.with(static_cast<Effect>(i));
  }
  return set;
}

std::vector<std::string> effectNames(EffectSet effects) {
  std::vector<std::string> names;
  effects.forEach([&](Effect e) { names.emplace_back(nameOf(e)); });
  return names;
}

}  // namespace whit
