#include "accuracy/measurement.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "accuracy/digest.h"
#include "accuracy/sweep.h"
#include "core/error.h"
#include "core/option_table.h"
#include "core/text.h"

namespace whit::accuracy {

namespace {

std::vector<std::string> wordsOf(std::string_view text) {
  std::istringstream stream{std::string(text)};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

// The canonical text of the option's value.
std::string labelOf(const std::string& option, const std::string& word) {
  RenderOptions options;
  setOption(options, option, word);
  return optionText(options, option);
}

Knob knobOf(const std::string& name, const KnobSpec& spec) {
  const auto labels = [&](std::string_view text) {
    std::vector<std::string> all = wordsOf(text);
    for (std::string& word : all) word = labelOf(name, word);
    return all;
  };
  const std::string exact = labelOf(name, std::string(spec.exact));
  const std::vector<std::string> spare = labels(spec.spare);
  Knob knob{name, spec.cause, {}, spec, exact};
  for (const std::string& label : labels(spec.values)) {
    KnobValue value{name, label, std::ranges::count(spare, label) > 0, false, {}};
    value.endless = label == exact && spec.endless;
    if (label != exact) value.alongside = wordsOf(spec.alongside);
    knob.values.push_back(std::move(value));
  }
  return knob;
}

RenderOptions presetOf(const RenderOptions& base, const std::string& quality) {
  RenderOptions options = base;
  setOption(options, "quality", quality);
  applyQuality(options, {});
  return options;
}

// Adds a point, unless an earlier one has its options.
void addPoint(std::vector<Point>& points, PointKind kind, const std::string& knob,
              const std::string& value, std::optional<Cause> cause, const RenderOptions& options,
              bool spare = false) {
  const std::string digest = digestOf(options);
  for (const Point& earlier : points) {
    if (digestOf(earlier.options) == digest) return;
  }
  Point& point = points.emplace_back();
  point.kind = kind;
  point.knob = knob;
  point.value = value;
  point.cause = cause;
  point.options = options;
  point.spare = spare;
}

// True if the knob's values are plain numbers of samples of pixels, lobes or lights.
bool countsSamples(const Knob& knob) {
  return std::ranges::all_of(knob.values, [](const KnobValue& value) {
    const bool whole = value.label.find_first_not_of("0123456789") == std::string::npos;
    return whole && value.alongside.empty();
  });
}

// The largest value of the knob that is at most `other`, or its first value.
const KnobValue& atMost(const Knob& knob, const KnobValue& other) {
  const auto number = [](const KnobValue& v) { return std::strtod(v.label.c_str(), nullptr); };
  const KnobValue* best = &knob.values.front();
  for (const KnobValue& value : knob.values) {
    if (number(value) <= number(other) && number(value) > number(*best)) best = &value;
  }
  return *best;
}

}  // namespace

void KnobValue::apply(RenderOptions& options) const {
  setOption(options, knob, label);
  for (std::size_t i = 0; i + 1 < alongside.size(); i += 2) {
    setOption(options, alongside[i].substr(2), alongside[i + 1]);
  }
}

std::string KnobValue::idle(EffectSet effects) const {
  if (!endless || !effects.has(Effect::transmission)) return {};
  return "without a cutoff the rays of both impulses double with every bounce";
}

void Knob::makeExact(RenderOptions& options, float cutoff) const {
  setOption(options, name, spec.endless ? formatValue(OptionSpec{}, cutoff) : exact);
}

std::string Knob::idle(EffectSet effects) const {
  for (const EffectSet needed : spec.needs) {
    if (needed.bits() == 0 || (needed.bits() & effects.bits()) != 0) continue;
    return "not among the effects of the scene: " + formatValue(OptionSpec{}, needed);
  }
  return {};
}

const std::vector<Knob>& allKnobs() {
  static const std::vector<Knob> kKnobs = [] {
    std::vector<Knob> knobs;
    const RenderOptions defaults;
    forEachOption(defaults, [&](const OptionSpec& spec, const auto&) {
      if (spec.knob) knobs.push_back(knobOf(std::string(spec.name), *spec.knob));
    });
    return knobs;
  }();
  return kKnobs;
}

std::vector<Knob> chooseKnobs(const std::vector<std::string>& names) {
  if (names.empty()) return allKnobs();
  std::vector<Knob> chosen;
  for (const Knob& knob : allKnobs()) {
    if (std::ranges::find(names, knob.name) != names.end()) chosen.push_back(knob);
  }
  for (const std::string& name : names) {
    if (std::ranges::find(chosen, name, &Knob::name) != chosen.end()) continue;
    throwUsage("--knobs: there is no knob '" + name + "'" + didYouMean(name, namesIn(allKnobs())));
  }
  return chosen;
}

float exactCutoff(EffectSet effects, bool full) {
  // 1e-5 is within one 8-bit code of 1e-6 in every pixel of the shipped glass scenes.
  if (!effects.has(Effect::transmission)) return 0;
  return full ? 1e-5f : 3e-5f;
}

RenderOptions exactIn(RenderOptions options, Cause cause, float cutoff) {
  for (const Knob& knob : allKnobs()) {
    if (knob.cause == cause) knob.makeExact(options, cutoff);
  }
  return options;
}

RenderOptions exactAtSameSamples(const RenderOptions& options, float cutoff) {
  RenderOptions exact = exactIn(options, Cause::algorithm, cutoff);
  exact = exactIn(exact, Cause::arithmetic, cutoff);
  exact.mode = Mode::reference;
  return exact;
}

RenderOptions referenceOptions(const RenderOptions& options, int samples, float cutoff) {
  RenderOptions exact = exactIn(exactAtSameSamples(options, cutoff), Cause::sampling, cutoff);
  exact.spp = samples;
  return exact;
}

RenderOptions transportOptions(const RenderOptions& options, int samples) {
  RenderOptions exact = referenceOptions(options, samples, kTransportCutoff);
  exact = exactIn(exact, Cause::transport, kTransportCutoff);
  exact.mode = Mode::packets;
  return exact;
}

std::string Point::label() const { return kind == PointKind::knob ? knob + "=" + value : value; }

PointList makePoints(const RenderOptions& base, EffectSet effects, const std::vector<Knob>& knobs) {
  PointList list;
  const bool standard = digestOf(base) == digestOf(presetOf(base, "standard"));
  addPoint(list.points, PointKind::baseline, "", standard ? "standard" : "baseline", {}, base);
  for (const QualityPreset& preset : qualityPresets()) {
    addPoint(list.points, PointKind::preset, "quality", preset.name, {},
             presetOf(base, preset.name));
  }
  for (const Knob& knob : knobs) {
    const std::string because = knob.idle(effects);
    if (!because.empty()) {
      list.idle.push_back({knob.name, because});
      continue;
    }
    for (const KnobValue& value : knob.values) {
      const std::string unable = value.idle(effects);
      if (!unable.empty()) {
        list.idle.push_back({knob.name + "=" + value.label, unable});
        continue;
      }
      RenderOptions options = base;
      value.apply(options);
      addPoint(list.points, PointKind::knob, knob.name, value.label, knob.cause, options,
               value.spare);
    }
  }
  return list;
}

std::vector<Knob> knobsTowardsTransport() {
  std::vector<Knob> knobs;
  for (const Knob& knob : allKnobs()) {
    if (knob.cause == Cause::transport || (knob.cause == Cause::sampling && countsSamples(knob))) {
      knobs.push_back(knob);
    }
  }
  return knobs;
}

void addTransportPoints(const RenderOptions& base, EffectSet effects,
                        const std::vector<Knob>& knobs, PointList& list) {
  const auto activeOf = [&](Cause cause) {
    std::vector<Knob> chosen;
    for (const Knob& knob : knobs) {
      const bool active = knob.cause == cause && countsSamples(knob) && knob.idle(effects).empty();
      if (active && knob.name != "spp") chosen.push_back(knob);
    }
    return chosen;
  };
  const std::vector<Knob> samplings = activeOf(Cause::sampling);
  for (const Knob& transport : activeOf(Cause::transport)) {
    for (const KnobValue& light : transport.values) {
      for (const QualityPreset& preset : qualityPresets()) {
        RenderOptions options = base;
        options.spp = presetOf(base, preset.name).spp;
        light.apply(options);
        if (!hasTransport(options)) continue;
        const std::string samples =
            options.spp == base.spp ? "" : "spp=" + std::to_string(options.spp) + " ";
        std::string label = samples + transport.name + "=" + light.label;
        addPoint(list.points, PointKind::joint, "", label, {}, options);
        for (const Knob& knob : samplings) {
          const KnobValue& samplesOfKnob = atMost(knob, light);
          samplesOfKnob.apply(options);
          label += " " + knob.name + "=" + samplesOfKnob.label;
        }
        addPoint(list.points, PointKind::joint, "", label, {}, options);
      }
    }
  }
}

}  // namespace whit::accuracy
