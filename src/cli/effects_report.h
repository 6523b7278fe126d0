// What each effect adds to a frame: as a table for people, as CSV, and as a picture.
#pragma once

#include <string>
#include <vector>

#include "cli/app/frame_summary.h"

namespace whit::cli {

// The scene after one more effect has been added to it; the first step is what it starts with.
struct EffectStep {
  std::string added;
  RunSummary run;
  double memoryMb = 0;  // scene and renderer
};

struct EffectCost {
  double frameMs = 0;    // of the step's frame
  double addedMs = 0;    // against the step before, as outsideMs and the others
  double outsideMs = 0;  // outside Embree
  double addedRays = 0, addedMb = 0;
};
// Times are medians of the differences between frames of the same turn: what the machine did to
// both cancels. The first step's cost is its own.
std::vector<EffectCost> effectCosts(const std::vector<EffectStep>& steps);

// Ends with effectsNote().
std::string effectsTable(const std::vector<EffectStep>& steps);
// Why the times do not add up, and by how much.
std::string effectsNote(const std::vector<EffectStep>& steps);
// effect, frame_ms, added_ms, added_outside_embree_ms, rays by kind, added_rays, memory_mb,
// added_memory_mb; a line a step.
std::string effectsCsv(const std::vector<EffectStep>& steps);
// Three columns, milliseconds, rays and megabytes, with a bar for each effect that is added; time
// outside Embree is a thin bar within the other. Follows the reader's light or dark scheme.
std::string effectsSvg(const std::vector<EffectStep>& steps);

}  // namespace whit::cli
