// What is drawn over the picture while it is compared with the reference.
#pragma once

#include "viewer/panel.h"

namespace whit::view {

// Between ImGui's NewFrame and Render: the line between both pictures at the share `split` of the
// window's width; with `words` also what is what, and what is known about their difference.
void drawComparison(const TracedFrame& frame, CompareMode mode, double split, bool words);

}  // namespace whit::view
