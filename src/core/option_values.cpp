#include "core/option_values.h"

#include <sstream>

#include "core/nearest_name.h"

namespace whit {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text + separator);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
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
  const auto found = std::find(choices.begin(), choices.end(), text);
  if (found == choices.end()) {
    throwUsage("--" + std::string(spec.name) + ": expected one of " + std::string(spec.words) +
               ", got '" + text + "'" + didYouMean(text, choices));
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
  for (int i = 0; i < kEffectCount; ++i) {
    if (!effects.has(static_cast<Effect>(i))) continue;
    names.emplace_back(kEffectNames[static_cast<std::size_t>(i)].name);
  }
  return names;
}

}  // namespace whit
