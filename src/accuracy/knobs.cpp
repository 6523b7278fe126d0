#include "accuracy/knobs.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "core/error.h"
#include "core/nearest_name.h"
#include "core/option_table.h"
#include "core/option_values.h"

namespace whit::accuracy {

namespace {

std::vector<std::string> wordsOf(std::string_view text) {
  std::istringstream stream{std::string(text)};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::string missing(const KnobSpec& spec, EffectSet effects) {
  for (const Need& need : spec.needs) {
    const bool needed = need.oneOf.bits() != 0;
    if (needed && (need.oneOf.bits() & effects.bits()) == 0) return std::string(need.without);
  }
  return {};
}

std::string whereRaysBranch(EffectSet effects) {
  if (!effects.has(Effect::transmission)) return {};
  return "without a cutoff the rays of both impulses double with every bounce";
}

// The canonical text of the option's value.
std::string labelOf(const std::string& option, const std::string& word) {
  RenderOptions options;
  setOption(options, option, word);
  return optionText(options, option);
}

// `words` are pairs of "--option" and value.
void setAll(RenderOptions& options, const std::vector<std::string>& words) {
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
    setOption(options, words[i].substr(2), words[i + 1]);
  }
}

Knob knobOf(const std::string& name, const KnobSpec& spec) {
  const std::string exact = labelOf(name, std::string(spec.exact));
  const auto labels = [&](std::string_view text) {
    std::vector<std::string> all = wordsOf(text);
    for (std::string& word : all) word = labelOf(name, word);
    return all;
  };
  const std::vector<std::string> crossed = labels(spec.crossed), spare = labels(spec.spare);
  const auto isIn = [](const std::vector<std::string>& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  Knob knob{name, spec.cause, {}, nullptr, nullptr};
  knob.idle = [spec](EffectSet effects) { return missing(spec, effects); };
  knob.makeExact = [=, endless = spec.endless](RenderOptions& o, const Exactness& exactness) {
    setOption(o, name, endless ? formatValue(OptionSpec{}, exactness.cutoff) : exact);
  };
  for (const std::string& label : labels(spec.values)) {
    KnobValue value{label, nullptr, isIn(crossed, label), isIn(spare, label), nullptr, {}};
    if (label == exact && spec.endless) value.idle = whereRaysBranch;
    if (label != exact) value.alongside = wordsOf(spec.alongside);
    std::vector<std::string> words{"--" + name, label};
    words.insert(words.end(), value.alongside.begin(), value.alongside.end());
    value.apply = [words](RenderOptions& o) { setAll(o, words); };
    knob.values.push_back(value);
  }
  return knob;
}

std::vector<Knob> makeKnobs() {
  std::vector<Knob> knobs;
  const RenderOptions options;
  forEachOption(options, [&](const OptionSpec& spec, const auto&) {
    if (spec.knob) knobs.push_back(knobOf(std::string(spec.name), *spec.knob));
  });
  return knobs;
}

}  // namespace

const std::vector<Knob>& allKnobs() {
  static const std::vector<Knob> knobs = makeKnobs();
  return knobs;
}

std::vector<Knob> chooseKnobs(const std::vector<std::string>& names) {
  if (names.empty()) return allKnobs();
  std::vector<std::string> known;
  for (const Knob& knob : allKnobs()) known.push_back(knob.name);
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throwUsage("--knobs: there is no knob '" + name + "'" + didYouMean(name, known));
  }
  std::vector<Knob> chosen;
  for (const Knob& knob : allKnobs()) {
    if (std::find(names.begin(), names.end(), knob.name) != names.end()) chosen.push_back(knob);
  }
  return chosen;
}

Exactness exactnessFor(EffectSet effects, bool full) {
  // 1e-5 is within one 8-bit code of 1e-6 in every pixel of the shipped glass scenes.
  if (effects.has(Effect::transmission)) return {full ? 1e-5f : 3e-5f};
  return {0};
}

RenderOptions exactIn(RenderOptions options, Cause cause, const Exactness& exactness) {
  for (const Knob& knob : allKnobs()) {
    if (knob.cause == cause) knob.makeExact(options, exactness);
  }
  return options;
}

RenderOptions exactAtSameSamples(const RenderOptions& options, const Exactness& exactness) {
  RenderOptions exact = exactIn(options, Cause::algorithm, exactness);
  exact = exactIn(exact, Cause::arithmetic, exactness);
  exact.mode = Mode::reference;
  return exact;
}

RenderOptions referenceOptions(const RenderOptions& options, int samples,
                               const Exactness& exactness) {
  RenderOptions exact = exactAtSameSamples(options, exactness);
  exact = exactIn(exact, Cause::sampling, exactness);
  exact.spp = samples;
  return exact;
}

bool hasTransport(const RenderOptions& options) {
  const RenderOptions defaults;
  return std::any_of(allKnobs().begin(), allKnobs().end(), [&](const Knob& knob) {
    return knob.cause == Cause::transport &&
           optionText(options, knob.name) != optionText(defaults, knob.name);
  });
}

double transportPaths(const RenderOptions& options) {
  double ofSurfel = 0;
  for (const Knob& knob : allKnobs()) {
    if (knob.cause != Cause::transport) continue;
    ofSurfel = std::max(ofSurfel, std::strtod(optionText(options, knob.name).c_str(), nullptr));
  }
  return options.spp * ofSurfel;
}

RenderOptions withoutTransport(RenderOptions options) {
  const RenderOptions defaults;
  for (const Knob& knob : allKnobs()) {
    if (knob.cause == Cause::transport)
      setOption(options, knob.name, optionText(defaults, knob.name));
  }
  return options;
}

RenderOptions transportOptions(const RenderOptions& options, int samples) {
  const Exactness exactness{kTransportCutoff};
  RenderOptions exact = referenceOptions(options, samples, exactness);
  exact = exactIn(exact, Cause::transport, exactness);
  exact.mode = Mode::packets;
  return exact;
}

}  // namespace whit::accuracy
