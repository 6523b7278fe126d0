#include "accuracy/knobs.h"

#include <algorithm>

#include "core/error.h"
#include "core/nearest_name.h"

namespace whit::accuracy {

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

}  // namespace whit::accuracy
