#include "accuracy/knobs.h"

#include <algorithm>
#include <charconv>
#include <initializer_list>

#include "core/error.h"
#include "core/nearest_name.h"

namespace whit::accuracy {

namespace {

using O = RenderOptions;

std::string labelOf(int value) { return std::to_string(value); }
std::string labelOf(bool value) { return value ? "on" : "off"; }
std::string labelOf(float value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

template <typename T>
struct Row {
  const char* name;
  T& (*field)(RenderOptions&);
  Cause cause;
  T exact;
  std::vector<T> values, joint;
};

template <typename T>
Knob knobOf(const Row<T>& row, Idle idle, const std::function<std::string(T)>& label) {
  Knob knob{row.name, row.cause, {}, nullptr, std::move(idle)};
  const auto set = [field = row.field](const T& value) {
    return [field, value](RenderOptions& options) { field(options) = value; };
  };
  knob.makeExact = [apply = set(row.exact)](RenderOptions& o, const Exactness&) { apply(o); };
  for (const T& value : row.values) {
    const bool joint = std::count(row.joint.begin(), row.joint.end(), value) > 0;
    knob.values.push_back({label(value), set(value), joint, nullptr});
  }
  return knob;
}
template <typename T>
Knob knobOf(const Row<T>& row, Idle idle) {
  return knobOf<T>(row, std::move(idle), [](T value) { return labelOf(value); });
}

std::string never(EffectSet) { return {}; }

std::string withoutImpulses(EffectSet effects) {
  if (effects.has(Effect::mirror) || effects.has(Effect::transmission)) return {};
  return "nothing in the scene reflects or refracts";
}
std::string withoutTransmission(EffectSet effects) {
  return effects.has(Effect::transmission) ? "" : "nothing in the scene is transparent";
}
std::string withoutLights(EffectSet effects) {
  return effects.has(Effect::lights) ? "" : "the scene has no light";
}
std::string withoutSecondaryRays(EffectSet effects) {
  return effects.has(Effect::shadows) ? std::string() : withoutImpulses(effects);
}
std::string whereRaysBranch(EffectSet effects) {
  if (!effects.has(Effect::transmission)) return {};
  return "without a cutoff the rays of both impulses double with every bounce";
}

Knob cutoffKnob() {
  Knob knob = knobOf<float>({"cutoff",
                             [](O& o) -> float& { return o.cutoff; },
                             Cause::algorithm,
                             0,
                             {0, 1e-4f, 3e-4f, 1e-3f, 4e-3f, 1.6e-2f},
                             {3e-4f, 4e-3f, 1.6e-2f}},
                            withoutImpulses);
  knob.values.front().idle = whereRaysBranch;
  knob.makeExact = [](O& o, const Exactness& exactness) { o.cutoff = exactness.cutoff; };
  return knob;
}

template <typename Enum>
std::function<std::string(Enum)> named(std::vector<std::string> names) {
  return [names = std::move(names)](Enum value) { return names[static_cast<std::size_t>(value)]; };
}

std::vector<Knob> makeKnobs() {
  constexpr Cause kSampling = Cause::sampling, kAlgorithm = Cause::algorithm,
                  kArithmetic = Cause::arithmetic;
  return {
      knobOf<int>(
          {"spp", [](O& o) -> int& { return o.spp; }, kSampling, 1, {1, 2, 4, 8, 16}, {1, 4, 16}},
          never),
      knobOf<int>({"depth",
                   [](O& o) -> int& { return o.depth; },
                   kAlgorithm,
                   kDepthLimit,
                   {0, 1, 2, 3, 4, 8, 16},
                   {2, 4, 8}},
                  withoutImpulses),
      cutoffKnob(),
      knobOf<float>({"light-cutoff",
                     [](O& o) -> float& { return o.shading.lightCutoff; },
                     kAlgorithm,
                     0,
                     {0, 1e-4f, 1e-3f, 4e-3f},
                     {0, 4e-3f}},
                    withoutLights),
      knobOf<FresnelModel>({"fresnel",
                            [](O& o) -> FresnelModel& { return o.shading.fresnel; },
                            kAlgorithm,
                            FresnelModel::exact,
                            {FresnelModel::exact, FresnelModel::schlick},
                            {}},
                           withoutTransmission, named<FresnelModel>({"exact", "schlick"})),
      knobOf<OffsetMethod>({"offset",
                            [](O& o) -> OffsetMethod& { return o.shading.offset; },
                            kAlgorithm,
                            OffsetMethod::bound,
                            {OffsetMethod::bound, OffsetMethod::fixed, OffsetMethod::wachterBinder},
                            {}},
                           withoutSecondaryRays,
                           named<OffsetMethod>({"bound", "fixed", "wachter-binder"})),
      knobOf<bool>({"robust",
                    [](O& o) -> bool& { return o.robust; },
                    kArithmetic,
                    true,
                    {true, false},
                    {true, false}},
                   never),
      knobOf<BvhQuality>({"bvh",
                          [](O& o) -> BvhQuality& { return o.bvh; },
                          kArithmetic,
                          BvhQuality::medium,
                          {BvhQuality::low, BvhQuality::medium, BvhQuality::high},
                          {}},
                         never, named<BvhQuality>({"low", "medium", "high"})),
      knobOf<int>(
          {"packet", [](O& o) -> int& { return o.packet; }, kArithmetic, 0, {1, 4, 8, 16}, {}},
          never),
      knobOf<EffectChoice>({"effects",
                            [](O& o) -> EffectChoice& { return o.effects; },
                            kArithmetic,
                            EffectChoice::automatic,
                            {EffectChoice::automatic, EffectChoice::all},
                            {}},
                           never, named<EffectChoice>({"auto", "all"})),
  };
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
    throwUsage("--knobs: there is no knob '" + name + "'; nearest: '" + nearestName(name, known) +
               "'");
  }
  std::vector<Knob> chosen;
  for (const Knob& knob : allKnobs()) {
    if (std::find(names.begin(), names.end(), knob.name) != names.end()) chosen.push_back(knob);
  }
  return chosen;
}

Exactness exactnessFor(EffectSet effects, bool full) {
  // 1e-5 is within one 8-bit code of 1e-6 in every pixel of the shipped glass scenes.
  if (effects.has(Effect::transmission)) return {full ? 1e-5f : 1e-4f};
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

}  // namespace whit::accuracy
