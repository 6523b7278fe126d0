// The costs that each effect adds to a frame: as a table for people, as CSV, and as data for a
// report.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cli/app/frame_summary.h"

namespace whit::cli {

// A scene with one more effect than in the step before. The first step is the scene without any of
// them.
struct EffectStep {
  std::string added;
  RunSummary run;
  double memoryMb = 0;  // scene and renderer
};

// All but frameMs are differences from the step before; the first step's cost is its own.
struct EffectCost {
  double frameMs = 0;
  double addedMs = 0;
  double outsideMs = 0;  // outside Embree
  double addedRays = 0, addedMb = 0;
};
// Times are medians of the differences between frames of the same turn, so that disturbances of
// both frames cancel.
std::vector<EffectCost> effectCosts(const std::vector<EffectStep>& steps);

// Ends with effectsNote().
std::string effectsTable(const std::vector<EffectStep>& steps);
// Explains why the times do not add up, and by how much.
std::string effectsNote(const std::vector<EffectStep>& steps);
// An object for each step: effect, frame_ms, added_ms, added_outside_embree_ms, rays by kind,
// added_rays, memory_mb, added_memory_mb.
nlohmann::ordered_json effectsRows(const std::vector<EffectStep>& steps);
std::string effectsCsv(const std::vector<EffectStep>& steps);
// Data for accuracy::reportPage(). `pictures` has the file of each step's picture, seen from the
// page.
nlohmann::ordered_json effectsJson(const std::vector<EffectStep>& steps,
                                   const std::vector<std::string>& pictures);

}  // namespace whit::cli
