// The costs that each effect adds to a frame, as data for a report and as a table for people.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "output/frame_summary.h"

namespace whit::cli {

// A scene with one more effect than in the step before. The first step is the scene without any of
// them.
struct EffectStep {
  std::string added;
  RunSummary run;
  double memoryMb = 0;  // scene and renderer
};

// An object for each step: effect, frame_ms, added_ms, added_outside_embree_ms, rays by
// kind, added_rays, memory_mb, added_memory_mb. Values that are added are differences from the step
// before; the first step's are its own. Added times are medians of the differences between frames
// of the same turn, so that disturbances of both frames cancel; KEY_low and KEY_high are the bounds
// of the interval in which each lies with a probability of 95 %, null of a single turn.
nlohmann::ordered_json effectsRows(const std::vector<EffectStep>& steps);
// The rows as "effects", with data for reportPage(). `pictures` has the file of each
// step's picture, seen from the page.
nlohmann::ordered_json effectsJson(const std::vector<EffectStep>& steps,
                                   const std::vector<std::string>& pictures);
// A table for people of what effectsJson() returns.
std::string effectsTable(const nlohmann::ordered_json& effects);

}  // namespace whit::cli
