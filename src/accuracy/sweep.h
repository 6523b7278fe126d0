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

struct SweepSettings {
  bool full = false;
  std::vector<std::string> knobs;  // none: all
  std::uint32_t seed = 1;          // of the order of the points
  // For timing the points of a scene; none: 20, 600 where full.
  std::optional<double> timingSeconds;
  std::string cacheFolder;
  std::string program;  // what identifies the code that renders
};

// `base` is the baseline, and scenes.given() has its --sphere-segments. The reference has 256
// samples (full) or 64; fewer, but at least 8 or 2, where its rays would exceed 400 or 30 million.
// Throws Error(io) when the cache cannot be written.
SceneSweep sweepScene(SceneVariants& scenes, const RenderOptions& base,
                      const SweepSettings& settings, Progress* progress);

}  // namespace whit::accuracy
