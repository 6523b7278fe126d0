#include "core/option_table.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <sstream>

#include "core/error.h"
#include "core/index.h"
#include "core/text.h"

namespace whit {

namespace {

// True if the values of the options, in their order, initialize a RenderOptions completely.
struct AreAllMembers {
  template <typename... Fields>
  constexpr auto operator()(const Option<Fields>&...) const {
    return std::bool_constant < requires { RenderOptions{std::declval<Fields&>()...}; }
    &&!requires { RenderOptions{std::declval<Fields&>()..., {}}; }
    > ();
  }
};
static_assert(
    decltype(withOptions(std::declval<RenderOptions&>(), AreAllMembers()))::value,
    "a member of RenderOptions or of ShadingChoices has no entry in withOptions(), or the "
    "entries are not in the order of the members");

// Calls visit(spec, field) for the option of this name.
template <typename Options, typename Visitor>
void visitOption(Options& options, const std::string& name, Visitor&& visit) {
  std::vector<std::string> names;
  bool found = false;

  forEachOption(options, [&](const OptionSpec& spec, auto& field) {
    names.emplace_back(spec.name);
    if (spec.name != name) return;
    found = true;
    visit(spec, field);
  });

  if (found) return;
  throwUsage(noOption(name, names));
}

// Calls visit(spec, a's, b's) for each option.
template <typename A, typename B, typename Visitor>
void forEachPair(A& a, B& b, Visitor&& visit) {
  withOptions(a, [&](const auto&... ofA) {
    withOptions(b, [&](const auto&... ofB) { (visit(ofA.spec, ofA.field, ofB.field), ...); });
  });
}

// The options of a preset, which trade time for accuracy.
constexpr std::array kPresetOptions{"spp",  "depth",  "cutoff",        "light-cutoff",
                                    "mode", "glossy", "light-samples", "ambient-samples"};

// Points of the fronts that `whit accuracy` finds on the shipped scenes (src/accuracy/README.md).
// The cutoff of standard takes 0.4 of the time of 1e-4 on glass, with a mean FLIP of 0.004 between
// the two pictures. Without a cutoff, rays that branch at every dielectric would double to the
// depth's limit. `good` has the effects that are left out by default, a sample or two of each
// for every sample of a pixel.
// The rows stand in the order of Quality.
constexpr std::array<const char*, kPresetOptions.size()> kPresets[] = {
    {"16", "64", "1e-3", "1e-3", "packets", "1", "2", "1"},
    {"1", "64", "1e-3", "0", "packets", "0", "1", "0"},
    {"16", "64", "1e-5", "0", "reference", "0", "1", "0"},
};

}  // namespace

std::string noOption(const std::string& name, const std::vector<std::string>& names) {
  return "there is no option '" + name + "'" + didYouMean(name, names);
}

void setOption(RenderOptions& options, const std::string& name, const std::string& text) {
  visitOption(options, name,
              [&](const OptionSpec& spec, auto& field) { parseValue(spec, text, field); });
}

std::string optionText(const RenderOptions& options, const std::string& name) {
  std::string text;
  visitOption(options, name,
              [&](const OptionSpec& spec, const auto& field) { text = formatValue(spec, field); });
  return text;
}

std::vector<std::pair<std::string, std::string>> pictureOptions(const RenderOptions& options) {
  std::vector<std::pair<std::string, std::string>> texts;
  forEachOption(options, [&](const OptionSpec& spec, const auto& field) {
    if (!spec.changesPicture) return;
    const std::string value = formatValue(spec, field);
    if (!value.empty()) texts.emplace_back(spec.name, value);
  });

  return texts;
}

Rebuild rebuildNeeded(const RenderOptions& a, const RenderOptions& b) {
  Rebuild needed = Rebuild::nothing;

  forEachPair(a, b, [&](const OptionSpec& spec, const auto& before, const auto& after) {
    if (!(before == after)) needed = std::max(needed, spec.rebuilds);
  });
  return needed;
}

void takeOver(const RenderOptions& from, Rebuild most, RenderOptions& to) {
  forEachPair(from, to, [&](const OptionSpec& spec, const auto& source, auto& target) {
    if (spec.rebuilds <= most) target = source;
  });
}

void applyQuality(RenderOptions& options, const std::set<std::string>& given) {
  const auto& preset = entryOf(kPresets, options.quality);
  for (const auto i : indices(preset)) {
    if (!given.contains(kPresetOptions[i])) setOption(options, kPresetOptions[i], preset[i]);
  }
}

std::vector<QualityPreset> qualityPresets() {
  const RenderOptions defaults;
  std::vector<QualityPreset> all;

  for (const auto i : indices(std::size(kPresets))) {
    RenderOptions options;
    options.quality = static_cast<Quality>(i);
    applyQuality(options, {});

    // The text of a preset lists only the values that differ from the defaults.
    QualityPreset preset{optionText(options, "quality"), ""};
    for (const char* name : kPresetOptions) {
      const std::string value = optionText(options, name);
      if (value == optionText(defaults, name)) continue;
      preset.options += (preset.options.empty() ? "--" : " --") + std::string(name) + " " + value;
    }

    all.push_back(std::move(preset));
  }

  return all;
}

std::vector<std::string> sceneOptionNames() {
  std::vector<std::string> names{"quality"};
  const RenderOptions defaults;

  forEachOption(defaults, [&](const OptionSpec& spec, const auto&) {
    // A scene may set options that change its picture, but not those of loading and of kernels.
    const bool ofFrames = spec.rebuilds == Rebuild::frame || spec.rebuilds == Rebuild::tables;
    if (spec.changesPicture && spec.inScenes && ofFrames) names.emplace_back(spec.name);
  });

  return names;
}

void applySceneOptions(const std::map<std::string, std::string>& stated,
                       std::set<std::string> given, RenderOptions& options) {
  // A preset on the command line replaces all of the scene's values of preset options.
  if (given.contains("quality")) {
    given.insert(kPresetOptions.begin(), kPresetOptions.end());
  } else if (const auto quality = stated.find("quality"); quality != stated.end()) {
    // A preset of the scene does not choose between packets and the scalar reference.
    given.insert("mode");
    setOption(options, quality->first, quality->second);
    applyQuality(options, given);
  }

  // Options on the command line take precedence over those of the scene.
  for (const auto& [name, value] : stated) {
    if (!given.contains(name)) setOption(options, name, value);
  }
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text + separator);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

bool readBackground(const std::string& text, Background& value) {
  using Kind = Background::Kind;
  value.kind = Kind::color;
  if (text == "sky") value.kind = Kind::sky;
  if (text == "transparent" || text == "none") value.kind = Kind::transparent;
  if (value.kind != Kind::color) return true;

  // A color is one or two hexadecimal digits for each channel, or one of two names.
  std::string digits = text.substr(text.starts_with('#') ? 1 : 0);
  if (text == "white" || text == "black") digits = text == "white" ? "fff" : "000";
  if (digits.size() == 3) {
    digits = {digits[0], digits[0], digits[1], digits[1], digits[2], digits[2]};
  }

  if (digits.size() != 6) return false;

  for (const auto i : indices(3)) {
    const char* const first = digits.data() + 2 * i;
    const auto [stop, error] = std::from_chars(first, first + 2, value.color[i], 16);
    if (error != std::errc() || stop != first + 2) return false;
  }

  return true;
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
