#include "viewer/label.h"

namespace whit::view {

void drawLabel(const ImVec2& at, const char* text, float margin, ImU32 color, ImU32 shade) {
  const ImVec2 size = ImGui::CalcTextSize(text);
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  list.AddRectFilled(ImVec2(at.x - margin, at.y - margin),
                     ImVec2(at.x + size.x + margin, at.y + size.y + margin), shade, margin);
  list.AddText(at, color, text);
}

}  // namespace whit::view
