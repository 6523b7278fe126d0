#include "viewer/color_scale.h"

#include <algorithm>

#include "core/formatted.h"
#include "inspect/metrics.h"

namespace whit::view {

namespace {

constexpr float kBarLines = 0.8f, kTickLines = 0.25f;  // heights of the font
constexpr ImU32 kInk = IM_COL32(255, 255, 255, 230);

}  // namespace

ColorScale differenceScale() {
  ColorScale scale{heatColor, {}};
  for (const int codes : kHeatTicks) {
    const bool last = codes == kHeatTicks.back();
    scale.ticks.push_back({heatPosition(codes), std::to_string(codes) + (last ? "+" : "")});
  }
  return scale;
}

ColorScale scaleOfView(DebugView view, const AmountScale& amounts) {
  ColorScale scale{[view](double share) { return colorAt(view, share); }, {}};
  for (const double at : {0.0, 0.5, 1.0}) {
    scale.ticks.push_back({at, formatted("%.3g", amountAt(view, amounts, at))});
  }
  return scale;
}

float heightOf(const ColorScale&) { return ImGui::GetFontSize() * (1 + kBarLines + kTickLines); }

void drawColorScale(const ColorScale& scale, const ImVec2& at, float width, ImDrawList& list) {
  constexpr int kSteps = 64;
  const float line = ImGui::GetFontSize(), bar = at.y + kBarLines * line;
  const auto x = [&](double share) { return at.x + static_cast<float>(share) * width; };
  for (int i = 0; i < kSteps; ++i) {
    const auto c = scale.color((i + 0.5) / kSteps);
    list.AddRectFilled(ImVec2(x(static_cast<double>(i) / kSteps), at.y),
                       ImVec2(x((i + 1.0) / kSteps), bar), IM_COL32(c[0], c[1], c[2], 255));
  }
  for (const ColorScale::Tick& tick : scale.ticks) {
    list.AddLine(ImVec2(x(tick.at), at.y), ImVec2(x(tick.at), bar + kTickLines * line), kInk);
    const float half = ImGui::CalcTextSize(tick.text.c_str()).x / 2;
    // Those at the ends stay above the bar.
    const float left = std::clamp(x(tick.at) - half, at.x, at.x + std::max(width - 2 * half, 0.0f));
    list.AddText(ImVec2(left, bar + kTickLines * line), kInk, tick.text.c_str());
  }
}

}  // namespace whit::view
