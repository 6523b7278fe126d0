// The knobs, which are options that trade accuracy for time: their values, which of them a scene
// calls for, and options that are exact. `whit accuracy` sweeps them,
// and --budget chooses among them.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/options.h"

namespace whit {

// The kind of error of an inexact value: rounding; rays and terms that are left out or approximated
// within Whitted's model; too few samples per pixel; or light transport that the model leaves out.
enum class Cause { arithmetic, algorithm, sampling, transport };

// A row of the table in knobs.cpp. Values are written as on the command line; lists of them are
// separated by blanks.
// NOLINTNEXTLINE(clang-analyzer-optin.performance.Padding): the order is that of a row's columns.
struct KnobSpec {
  std::string_view name = {};
  Cause cause = Cause::algorithm;
  std::string_view exact = {};
  std::string_view values = {};  // the sweep
  // Values between others, or that make the same picture by construction: a quick sweep measures
  // them last, if there is time.
  std::string_view minor = {};
  // Effects that the option changes: it is swept in scenes that use one of each set.
  std::array<EffectSet, 2> needs = {};
  // Options that the inexact values need to have an effect, as on the command line.
  std::string_view prerequisites = {};
  // With the exact value, branching rays would never end: scenes with such rays skip it.
  bool endless = false;
};

struct KnobValue {
  std::string knob, label;                 // as on the command line: --KNOB LABEL
  bool minor = false;                      // see KnobSpec
  bool endless = false;                    // branching rays never end with it
  std::vector<std::string> prerequisites;  // other options that it sets, as on the command line

  void apply(RenderOptions& options) const;
  // The reason why the value is impossible in scenes with these effects, beyond the knob's own;
  // empty if there is none.
  std::string idle(EffectSet effects) const;
};

// The cutoff that counts as exact. It is not 0 in scenes with glass, where rays split in two at
// every bounce and only the cutoff ends that.
float exactCutoff(EffectSet effects, bool full);

struct Knob {
  std::string name;
  Cause cause = Cause::algorithm;
  std::vector<KnobValue> values;
  KnobSpec spec;
  std::string exact;  // label

  void makeExact(RenderOptions& options, float cutoff) const;
  // The reason why the knob changes nothing in scenes with these effects; empty if there is none.
  std::string idle(EffectSet effects) const;
};

const std::vector<Knob>& allKnobs();

// The knobs with these names, or all knobs if there are no names, in the table's order. Throws
// Error(usage) with the nearest name for an unknown one.
std::vector<Knob> chooseKnobs(const std::vector<std::string>& names);

// `options` with every knob of the cause at its exact value.
RenderOptions exactIn(RenderOptions options, Cause cause, float cutoff);
// The picture that an image with `options` is measured against at equal samples: by the scalar
// reference, exact in everything except sampling.
RenderOptions exactAtSameSamples(const RenderOptions& options, float cutoff);
// The same with `samples` samples in every pixel, the reference of all points.
RenderOptions referenceOptions(const RenderOptions& options, int samples, float cutoff);

struct CostAndError {
  double cost = 0, error = 0;
};

// Index of the least error whose cost is at most `most`, of the least cost among equal errors.
// Points that are not finite are never the best.
std::optional<std::size_t> bestWithin(const std::vector<CostAndError>& points, double most);

}  // namespace whit
