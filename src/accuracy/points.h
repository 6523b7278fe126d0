// Which options a sweep measures.
#pragma once

#include <cstdint>
#include <vector>

#include "accuracy/measurement.h"

namespace whit::accuracy {

struct PointList {
  std::vector<Point> points;  // the baseline first; no two with the same options
  std::vector<IdleKnob> idle;
};

// `base` with one knob changed at a time, the presets of --quality, and with `jointLimit` above 0
// combinations of the knobs' crossed values, chosen with `seed` where there are more than that.
// Knobs that do nothing in a scene with these effects are left out with the reason.
PointList makePoints(const RenderOptions& base, EffectSet effects, const std::vector<Knob>& knobs,
                     std::size_t jointLimit, std::uint32_t seed);

}  // namespace whit::accuracy
