// The sweep of a scene: measures it with one choice of options after the other.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/measurement.h"
#include "accuracy/scene_variants.h"

namespace whit::accuracy {

// Which options a sweep measures.
struct PointList {
  std::vector<Point> points;  // the baseline first; no two with the same options
  std::vector<IdleKnob> idle;
};

// `base` with one knob changed at a time, the presets of --quality, and with `jointLimit` above 0
// combinations of the knobs' crossed values, chosen with `seed` where there are more than that.
// Knobs that do nothing in a scene with these effects are left out with the reason.
PointList makePoints(const RenderOptions& base, EffectSet effects, const std::vector<Knob>& knobs,
                     std::size_t jointLimit, std::uint32_t seed);

// The knobs whose values lead from a draft to all transport: more samples of a pixel, a lobe or a
// light, and light that the model leaves out.
std::vector<Knob> knobsTowardsTransport();
// Likewise combinations of the presets' samples a pixel with each value of the knobs of transport,
// alone and with as many samples of lobes and lights. Of these knobs, and not those in `list`.
void addTransportPoints(const RenderOptions& base, EffectSet effects,
                        const std::vector<Knob>& knobs, PointList& list);

struct SweepSettings {
  Truth truth = Truth::model;
  bool full = false;
  // None: all; of a quick sweep with Truth::transport, knobsTowardsTransport().
  std::vector<std::string> knobs;
  std::uint32_t seed = 1;  // of the order of the points
  // For timing the points of a scene; none: 20, 600 where full.
  std::optional<double> timingSeconds;
  std::string cacheFolder;
  std::string program;  // what identifies the code that renders
};

// `base` is the baseline, and scenes.given() has its --sphere-segments. The reference has 256
// samples (full) or 64; fewer, but at least 8 or 2, where its rays would exceed 400 or 30 million.
// The picture with all transport, if that is the truth, has as many in each of its passes, or fewer
// for it to take no more than 4e9 or 400 million rays. Throws Error(io) when the cache cannot be
// written.
SceneSweep sweepScene(SceneVariants& scenes, const RenderOptions& base,
                      const SweepSettings& settings, Progress* progress);

}  // namespace whit::accuracy
