// The options that trade accuracy for time, as the table of options in core/options.h has them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/options.h"

namespace whit::accuracy {

inline constexpr const char* kCauseNames[] = {"arithmetic", "algorithm", "sampling", "transport"};

// Why something does nothing, or cannot be done, in scenes with these effects; empty where it can.
using Idle = std::function<std::string(EffectSet)>;

struct KnobValue {
  std::string label;  // as on the command line: --KNOB LABEL
  std::function<void(RenderOptions&)> apply;
  bool crossed = false, spare = false;  // see KnobSpec
  Idle idle;                            // null: wherever the knob does something
  // What else it sets, as on the command line.
  std::vector<std::string> alongside;
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

// Whether they ask for light that Whitted's model leaves out; and the same options without it.
bool hasTransport(const RenderOptions& options);
RenderOptions withoutTransport(RenderOptions options);
// How many paths of such light a pixel has: its samples, times those of a surfel.
double transportPaths(const RenderOptions& options);
// What contributes less is left out of the picture with all transport: paths from diffuse surface
// to diffuse surface end nowhere by themselves.
inline constexpr float kTransportCutoff = 1e-4f;
// By packets, exact and with all transport, `samples` samples in every pixel.
RenderOptions transportOptions(const RenderOptions& options, int samples);

}  // namespace whit::accuracy
