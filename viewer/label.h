// Words over the picture.
#pragma once

#include <imgui.h>

namespace whit::view {

inline constexpr ImU32 kWhite = IM_COL32(255, 255, 255, 230), kShade = IM_COL32(0, 0, 0, 150);

// A shade goes beyond the text by `margin`, and is as round. Above panels, which would hide it.
void drawLabel(const ImVec2& at, const char* text, float margin = 3, ImU32 color = kWhite,
               ImU32 shade = kShade);

}  // namespace whit::view
