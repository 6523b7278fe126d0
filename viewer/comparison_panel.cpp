#include "viewer/comparison_panel.h"

#include <imgui.h>

#include <cstdio>

namespace whit::view {

namespace {

constexpr ImU32 kWhite = IM_COL32(255, 255, 255, 230), kShade = IM_COL32(0, 0, 0, 150);

void drawLabel(ImDrawList& list, const ImVec2& at, const char* text) {
  const ImVec2 size = ImGui::CalcTextSize(text);
  constexpr float kMargin = 3;
  list.AddRectFilled(ImVec2(at.x - kMargin, at.y - kMargin),
                     ImVec2(at.x + size.x + kMargin, at.y + size.y + kMargin), kShade, kMargin);
  list.AddText(at, kWhite, text);
}

// The line behind the panels, over the picture; the words above all: in a small window a panel may
// lie where they belong.
void drawSplit(double split, bool labels) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float x = static_cast<float>(split) * window.x, gap = ImGui::GetFontSize();
  const float y = window.y - 5 * gap;
  list.AddLine(ImVec2(x + 1, 0), ImVec2(x + 1, window.y), kShade, 3);
  list.AddLine(ImVec2(x, 0), ImVec2(x, window.y), kWhite, 1);
  if (!labels) return;
  ImDrawList& above = *ImGui::GetForegroundDrawList();
  drawLabel(above, ImVec2(x - gap - ImGui::CalcTextSize("packets").x, y), "packets");
  drawLabel(above, ImVec2(x + gap, y), "reference");
}

// In short lines, which have room beside the panel in a small window.
void drawDifference(const TracedFrame& frame, const Comparison& comparison) {
  const ImageDifference& d = *comparison.difference;
  ImGui::Text("RMSE  %.3g   PSNR %.1f dB", d.rmse, d.psnrDb);
  ImGui::Text("FLIP  %.2g", d.flipMean);
  ImGui::Text("8-bit codes: largest %d", d.maxCode);
  ImGui::Text("             over 1 in %.3f %%", d.pixelsGe2CodesPct);
  ImGui::Text("packets   %.1f ms", frame.stats.frameMs);
  ImGui::Text("reference %.0f ms", comparison.referenceMs);
}

void drawFindings(const TracedFrame& frame, bool heat) {
  ImGui::TextUnformatted(heat ? "differences in 8-bit codes" : "packets against the reference");
  if (!frame.comparison) {
    ImGui::TextDisabled("waits until nothing moves");
  } else if (frame.comparison->complete()) {
    drawDifference(frame, *frame.comparison);
  } else {
    char text[48];
    std::snprintf(text, sizeof text, "reference: %.0f %%", 100 * frame.comparison->progress());
    ImGui::ProgressBar(static_cast<float>(frame.comparison->progress()),
                       ImVec2(ImGui::GetFontSize() * 15, 0), text);
  }
}

}  // namespace

void drawComparison(const TracedFrame& frame, CompareMode mode, double split, bool words) {
  const bool under = frame.comparison.has_value();
  const bool heat = mode == CompareMode::heatMap && under && frame.comparison->complete();
  if (under && !heat) drawSplit(split, words);
  if (!words) return;
  const float gap = 10;
  ImGui::SetNextWindowPos(ImVec2(ImGui::GetIO().DisplaySize.x - gap, gap), ImGuiCond_Always,
                          ImVec2(1, 0));
  ImGui::SetNextWindowBgAlpha(kPanelAlpha);
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                      ImGuiWindowFlags_AlwaysAutoResize |
                                      ImGuiWindowFlags_NoFocusOnAppearing;
  if (ImGui::Begin("comparison", nullptr, kFlags)) drawFindings(frame, heat);
  ImGui::End();
}

}  // namespace whit::view
