// The options that trade accuracy for time. To sweep a new one, add a row to the table in
// knob_table.cpp: its values, which of them is exact, what kind of error the others make, and in
// which scenes it does nothing.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/effects.h"
#include "core/options.h"

namespace whit::accuracy {

// What an inexact value costs the picture: rounding (the same rays, computed otherwise), rays and
// terms that are left out or approximated, or too few samples of a pixel.
enum class Cause { arithmetic, algorithm, sampling };
inline constexpr const char* kCauseNames[] = {"arithmetic", "algorithm", "sampling"};

// Why something does nothing, or cannot be done, in scenes with these effects; empty where it can.
using Idle = std::function<std::string(EffectSet)>;

struct KnobValue {
  std::string label;  // as on the command line: --KNOB LABEL
  std::function<void(RenderOptions&)> apply;
  bool joint = false;  // takes part in the combinations of a full sweep
  Idle idle;           // null: wherever the knob does something
  // What else it sets, as on the command line: other options that it needs to have an effect.
  std::vector<std::string> alongside;
  // Between others, or the same picture by construction: a quick sweep has it last, and does
  // without when its minute is over.
  bool spare = false;
};

// Where both a reflected and a refracted ray go on, rays double with every bounce, and only the
// cutoff ends that: what counts as exact there is a cutoff small enough, not none.
struct Exactness {
  float cutoff = 0;
};
Exactness exactnessFor(EffectSet effects, bool full);

struct Knob {
  std::string name;
  Cause cause = Cause::algorithm;
  std::vector<KnobValue> values;
  std::function<void(RenderOptions&, const Exactness&)> makeExact;
  Idle idle;
};

const std::vector<Knob>& allKnobs();

// The knobs of these names, in the table's order; all for none. Throws Error(usage) that names the
// nearest for one that does not exist.
std::vector<Knob> chooseKnobs(const std::vector<std::string>& names);

// `options` with every knob of the cause at its exact value.
RenderOptions exactIn(RenderOptions options, Cause cause, const Exactness& exactness);
// What an image by `options` is measured against at equal samples: the scalar reference, exact in
// all but sampling.
RenderOptions exactAtSameSamples(const RenderOptions& options, const Exactness& exactness);
// The same with `samples` samples in every pixel: the reference of all.
RenderOptions referenceOptions(const RenderOptions& options, int samples,
                               const Exactness& exactness);

}  // namespace whit::accuracy
