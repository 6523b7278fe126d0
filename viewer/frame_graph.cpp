#include "viewer/frame_graph.h"

#include <imgui.h>

#include <algorithm>
#include <cstdio>

namespace whit::view {

void FrameGraph::add(double ms) {
  times_[next_] = static_cast<float>(ms);
  next_ = (next_ + 1) % times_.size();
  count_ = std::min(count_ + 1, times_.size());
}

void FrameGraph::draw(double rate) const {
  const auto budget = static_cast<float>(1000 / rate);
  const float highest = *std::max_element(times_.begin(), times_.end());
  const float scale = 1.25f * std::max(highest, budget);
  const ImVec2 size(ImGui::GetContentRegionAvail().x, ImGui::GetFontSize() * 3);
  const int oldest = count_ < times_.size() ? 0 : static_cast<int>(next_);
  ImGui::PlotLines("##times", times_.data(), static_cast<int>(count_), oldest,
                   count_ == 0 ? "nothing has moved yet" : nullptr, 0, scale, size);
  const ImVec2 padding = ImGui::GetStyle().FramePadding;
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  const auto heightOf = [&](float ms) {
    return to.y - padding.y - ms / scale * (to.y - from.y - 2 * padding.y);
  };
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 color = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  const float y = heightOf(budget);
  list.AddLine(ImVec2(from.x, y), ImVec2(to.x, y), ImGui::GetColorU32(ImGuiCol_Border));
  char text[48];
  std::snprintf(text, sizeof text, "%.1f ms for %.0f/s", static_cast<double>(budget), rate);
  // Below its line, unless that lies low.
  const float below = y + ImGui::GetFontSize() < to.y ? y : y - ImGui::GetFontSize();
  list.AddText(ImVec2(to.x - padding.x - ImGui::CalcTextSize(text).x, below), color, text);
  if (count_ == 0) return;
  std::snprintf(text, sizeof text, "%.1f ms at most", static_cast<double>(highest));
  list.AddText(ImVec2(from.x + padding.x, from.y), color, text);
}

}  // namespace whit::view
