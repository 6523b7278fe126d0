// The tab of the options: presets, options, effects and the choice of view. The functions draw
// between Begin and End of Dear ImGui.
#pragma once

#include <string>
#include <vector>

#include "viewer/session/view_state.h"

namespace whit::view {

// Appends what the user asks for to `said`, in lines of verbs.
void drawOptions(const ViewState& state, std::vector<std::string>& said);
// Lists the costs that exceed the noise, the largest first.
void drawCosts(const std::vector<KnobCost>& costs);

}  // namespace whit::view
