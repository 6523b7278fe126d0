#include "inspect/knobs.h"

#include <cmath>
#include <sstream>

#include "core/error.h"
#include "core/index.h"
#include "core/option_table.h"
#include "core/text.h"

namespace whit {

namespace {

constexpr EffectSet only(Effect effect) { return EffectSet().with(effect); }
constexpr EffectSet kImpulses = only(Effect::mirror).with(Effect::transmission);
constexpr EffectSet kVertexNormals = only(Effect::smoothNormals);

using enum Cause;

// The columns are name, cause, exact value, values, minor values, needs, prerequisites, endless.
// The order is that of the options.
constexpr KnobSpec kKnobs[] = {
    {"spp", sampling, "1", "1 2 4 8 16", "2"},
    // The base has 24 samples, not 16, to make up for the pixels that get one.
    {"adaptive", sampling, "off", "off on", "", {}, "--spp 24"},
    {"contrast", sampling, "8", "8 4 16 24", "", {}, "--adaptive on --spp 24"},
    {"depth", algorithm, "64", "0 1 2 3 4 8 16 32 64", "1 3 16 32", {kImpulses}},
    // The exact numbers of samples are those of each of the many samples per pixel of the
    // reference.
    {"glossy", sampling, "4", "0 1 4 16", "1 4 16", {only(Effect::glossyReflection)}},
    {"indirect", transport, "4", "0 1 4 16 64", "", {only(Effect::indirect)}},
    {"cutoff", algorithm, "0", "0 1e-4 3e-4 1e-3 4e-3 1.6e-2", "3e-4", {kImpulses}, "", true},
    {"roulette", sampling, "0", "0 0.01 0.1 0.5", "0.01 0.1 0.5", {kImpulses}},
    {"light-samples", sampling, "4", "1 4 16", "", {only(Effect::softShadows)}},
    {"ambient-samples", sampling, "4", "0 1 4 16", "1 16", {only(Effect::ambientOcclusion)}},
    {"light-cutoff", algorithm, "0", "0 1e-4 1e-3 4e-3", "1e-4", {only(Effect::lights)}},
    {"fresnel", algorithm, "exact", "exact schlick", "", {only(Effect::transmission)}},
    {"texture-filter",
     algorithm,
     "trilinear",
     "trilinear bilinear nearest",
     "",
     {only(Effect::textures).with(Effect::normalMaps)}},
    {"offset",
     algorithm,
     "bound",
     "bound fixed wachter-binder",
     "fixed wachter-binder",
     {kImpulses.with(Effect::shadows)}},
    {"terminator", algorithm, "off", "off on", "on", {kVertexNormals, only(Effect::shadows)}},
    {"bend",
     algorithm,
     "on",
     "on off",
     "off",
     {kVertexNormals.with(Effect::normalMaps), kImpulses}},
    {"packet", arithmetic, "auto", "1 4 8 16", "1 4 8 16"},
    {"mode", arithmetic, "reference", "packets reference", "reference"},
    {"robust", arithmetic, "on", "on off"},
    {"retry", arithmetic, "on", "on off", "off"},
    {"bvh", arithmetic, "medium", "low medium high", "low high"},
    {"effects", arithmetic, "auto", "auto all", "all"},
};

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

Knob knobOf(const KnobSpec& spec) {
  const std::string name(spec.name);
  const auto labels = [&](std::string_view text) {
    std::vector<std::string> all = wordsOf(text);
    for (std::string& word : all) word = labelOf(name, word);
    return all;
  };

  const std::string exact = labelOf(name, std::string(spec.exact));
  const std::vector<std::string> minor = labels(spec.minor);
  Knob knob{name, spec.cause, {}, spec, exact};

  for (const std::string& label : labels(spec.values)) {
    KnobValue value{name, label, contains(minor, label), false, {}};
    value.endless = label == exact && spec.endless;
    if (label != exact) value.prerequisites = wordsOf(spec.prerequisites);
    knob.values.push_back(std::move(value));
  }
  return knob;
}

}  // namespace

void KnobValue::apply(RenderOptions& options) const {
  setOption(options, knob, label);
  for (std::size_t i = 0; i + 1 < prerequisites.size(); i += 2) {
    setOption(options, prerequisites[i].substr(2), prerequisites[i + 1]);
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
  static const std::vector<Knob> knobs = [] {
    std::vector<Knob> made;
    for (const KnobSpec& spec : kKnobs) made.push_back(knobOf(spec));
    return made;
  }();
  return knobs;
}

std::vector<Knob> chooseKnobs(const std::vector<std::string>& names) {
  if (names.empty()) return allKnobs();

  std::vector<Knob> chosen;
  for (const Knob& knob : allKnobs()) {
    if (contains(names, knob.name)) chosen.push_back(knob);
  }

  for (const std::string& name : names) {
    if (contains(chosen, name, &Knob::name)) continue;
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

std::optional<std::size_t> bestWithin(const std::vector<CostAndError>& points, double most) {
  std::optional<std::size_t> best;
  for (const auto i : indices(points)) {
    const auto& [cost, error] = points[i];
    if (!std::isfinite(error) || !(cost <= most)) continue;

    const bool better = !best || error < points[*best].error ||
                        (error == points[*best].error && cost < points[*best].cost);
    if (better) best = i;
  }
  return best;
}

}  // namespace whit
