// The points that a sweep measures: choices of options.
#pragma once

#include <vector>

#include "accuracy/measurement.h"

namespace whit::accuracy {

// Points, and what is left out of them.
struct PointList {
  std::vector<Point> points;  // the baseline first; all with different options
  std::vector<IdleKnob> idle;
};

// Returns `base` with one knob changed at a time, and the presets of --quality. Knobs that change
// nothing in a scene with these effects are left out.
PointList makePoints(const RenderOptions& base, EffectSet effects, const std::vector<Knob>& knobs);

// Returns the knobs that lead from one sample to all transport: numbers of samples of a pixel, a
// lobe or a light, and light that the model leaves out.
std::vector<Knob> knobsTowardsTransport();
// Adds combinations of the presets' samples a pixel with each value of the knobs of transport,
// alone and with as many samples of lobes and lights. Leaves out points that `list` has already.
void addTransportPoints(const RenderOptions& base, EffectSet effects,
                        const std::vector<Knob>& knobs, PointList& list);

}  // namespace whit::accuracy
