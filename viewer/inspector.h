// What is known of the pixel under the pointer, in whatever is shown of it.
#pragma once

#include <array>
#include <string>

#include "viewer/traced_frame.h"

namespace whit::view {

// Lines about that pixel of a window of this size: what the view that was traced says, or the
// radiance; `compared`: also the reference's. With units. Empty beside the picture.
std::string inspect(const TracedFrame& frame, bool compared, const ImageSize& window,
                    const std::array<int, 2>& pixel);

// Between ImGui's NewFrame and Render: beside the pointer, inside the window.
void drawInspection(const std::string& lines, double pointerX, double pointerY);

}  // namespace whit::view
