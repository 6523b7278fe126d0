// The rays of a picked pixel: as a tree in a tab of the panel, and as lines in the scene.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "viewer/session/view_state.h"

namespace whit::view {

// Draws the tree between Begin and End of Dear ImGui, or says how to pick a pixel. Returns the ray
// that is pointed at, or kNoCounterpart.
std::size_t drawRayTree(const ViewState& state, bool& lines, std::vector<std::string>& said);

// Draws the rays as lines behind the panels, as this camera sees them.
void drawRayLines(const RayPick& pick, const Camera& camera, std::size_t pointedAt);

}  // namespace whit::view
