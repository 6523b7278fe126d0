// The options of a render as sliders, boxes and lists, with what each has cost.
#pragma once

#include "viewer/knob_costs.h"

namespace whit::view {

// Presets, then every option that the table of options has in this tab. Between ImGui's Begin and
// End.
void drawKnobs(RenderOptions& options, const KnobCosts& costs);

// Beside the control of that knob or effect: what it costs, as measured, or else what its last
// change has done; nothing where neither is known.
void drawCost(const KnobCosts& costs, const std::string& name);

// Those that it has in the picture's tab: exposure and tone curve.
void drawDisplay(RenderOptions& options);

// The last change, before and after: frame time and rays by kind. Nothing before the first.
void drawLastChange(const KnobCosts& costs);

}  // namespace whit::view
