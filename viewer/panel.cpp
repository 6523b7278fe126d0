#include "viewer/panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "cli/app/frame_summary.h"
#include "core/formatted.h"
#include "viewer/resolution_control.h"

namespace whit::view {

namespace {

template <typename... Values>
void drawCell(const char* format, Values... values) {
  ImGui::TableNextColumn();
  ImGui::Text(format, values...);
}

void drawStages(const FrameStats& stats) {
  const double frame = std::max(stats.frameMs, 1e-9);
  for (std::size_t i = 0; i < kStageCount; ++i) {
    const double ms = stats.stageMs(static_cast<Stage>(i));
    ImGui::ProgressBar(static_cast<float>(ms / frame), ImVec2(-1, 0),
                       formatted("%s %.2f ms", kStageNames[i].data(), ms).c_str());
  }
}

void drawRays(const FrameStats& stats, EffectSet effects) {
  if (!ImGui::BeginTable("rays", 4)) return;
  for (const char* heading : {"rays", "thousands", "Mray/s", "lanes %"}) {
    ImGui::TableSetupColumn(heading);
  }
  ImGui::TableHeadersRow();
  for (std::size_t i = 0; i < kRayKindCount; ++i) {
    if (!kRayKinds[i].calledForBy(effects)) continue;
    const RayTally& tally = stats.meter.tally[i];
    drawCell("%s", kRayKinds[i].name.data());
    drawCell("%.1f", static_cast<double>(tally.rays) / 1e3);
    drawCell("%.2f", cli::mraysPerSecond(tally.rays, stats.frameMs));
    drawCell("%.1f", 100 * cli::lanesFilled(tally));
  }
  const auto& [lit, dark] = stats.meter.shadows;
  if (lit + dark > 0) {
    drawCell("%s", "shadow, proved");
    drawCell("%.1f", static_cast<double>(lit + dark) / 1e3);
    drawCell("%s", "-");
    drawCell("%s", "-");
  }
  ImGui::EndTable();
}

// Draws a box for each effect, grayed where the scene does not call for it, and the reason.
void drawEffects(const TracedFrame& frame, const std::vector<KnobCost>& costs, EffectSet& disable) {
  for (int i = 0; i < kEffectCount; ++i) {
    const auto effect = static_cast<Effect>(i);
    const EffectReason& reason = frame.reasons[static_cast<std::size_t>(i)];
    const std::string name(kEffectNames[static_cast<std::size_t>(i)].name);
    bool on = reason.on && !disable.has(effect);
    ImGui::BeginDisabled(!reason.on);
    if (ImGui::Checkbox(name.c_str(), &on)) {
      disable = on ? disable.without(effect) : disable.with(effect);
    }
    ImGui::EndDisabled();
    drawCost(costs, name);
    ImGui::SameLine();
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::TextWrapped("%s", reason.because.c_str());
    ImGui::PopStyleColor();
  }
}

void drawPicture(PanelSettings& settings) {
  drawOptions(Tab::picture, settings.options, {});
  auto rate = static_cast<float>(settings.rate);
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 11);
  if (ImGui::SliderFloat("frames/s", &rate, kLeastRate, kLargestRate, "%.0f")) {
    settings.rate = static_cast<double>(rate);
  }
  ImGui::Checkbox("supersample at rest (N)", &settings.supersample);
}

void drawEffectColors() {
  for (const EffectColor& c : effectColors()) {
    const auto& name = kEffectNames[static_cast<std::size_t>(c.effect)].name;
    const ImVec4 color(c.color[0], c.color[1], c.color[2], 1);
    ImGui::ColorButton(name.data(), color, ImGuiColorEditFlags_NoTooltip,
                       ImVec2(ImGui::GetFontSize(), ImGui::GetFontSize()));
    ImGui::SameLine();
    ImGui::TextUnformatted(name.data());
  }
}

// Draws the choice of debug view and comparison.
void drawView(const TracedFrame& frame, PanelSettings& settings) {
  int view = static_cast<int>(settings.view), compare = static_cast<int>(settings.compare);
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 11);
  if (ImGui::Combo("view (V)", &view, kDebugViewNames.data(),
                   static_cast<int>(kDebugViewNames.size()))) {
    settings.view = static_cast<DebugView>(view);
  }
  const std::string legend = frame.debug ? frame.debug->legend() : std::string();
  if (!legend.empty()) ImGui::TextWrapped("%s", legend.c_str());
  if (settings.view == DebugView::effects) drawEffectColors();
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 11);
  if (ImGui::Combo("reference (X)", &compare, "not compared\0side by side\0differences\0")) {
    settings.compare = static_cast<CompareMode>(compare);
  }
}

void drawKeys() {
  if (!ImGui::BeginTable("keys", 2)) return;
  ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthFixed);
  ImGui::TableSetupColumn("what they do", ImGuiTableColumnFlags_WidthStretch);
  for (const KeyHelp& help : keyHelp()) {
    drawCell("%s", help.keys);
    ImGui::TableNextColumn();
    ImGui::TextWrapped("%s", help.text);
  }
  ImGui::EndTable();
}

void drawTimes(const TracedFrame& frame) {
  const FrameStats& stats = frame.stats;
  ImGui::Text("%s, %s", frame.scene->scene.name.c_str(), frame.surfaces.c_str());
  const Image& image = frame.film.image;
  ImGui::Text("%d x %d, %d sample%s a pixel%s", image.width, image.height, frame.request.spp,
              frame.request.spp == 1 ? "" : "s", errorText(frame.sampleError).c_str());
  ImGui::Text("%s, packets of %d, %d thread%s", frame.machine.simd.c_str(), frame.machine.packet,
              frame.machine.threads, frame.machine.threads == 1 ? "" : "s");
  ImGui::Text("%.2f ms traced, %.2f in Embree", stats.frameMs, stats.embreeMs());
}

// Draws the newest time at the right, and a line at the time that a frame may take to hold `rate`
// frames a second.
void drawGraph(const std::vector<float>& times, double rate) {
  const auto budget = static_cast<float>(1000 / rate);
  const float highest = times.empty() ? 0 : *std::max_element(times.begin(), times.end());
  const float scale = 1.25f * std::max(highest, budget);
  const ImVec2 size(ImGui::GetContentRegionAvail().x, ImGui::GetFontSize() * 3);
  const std::string text = times.empty()
                               ? "nothing has moved yet"
                               : formatted("at most %.1f ms; %.1f ms hold %.0f/s",
                                           static_cast<double>(highest), 1000 / rate, rate);
  ImGui::PlotLines("##times", times.data(), static_cast<int>(times.size()), 0, text.c_str(), 0,
                   scale, size);
  const float padding = ImGui::GetStyle().FramePadding.y;
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  const float y = to.y - padding - budget / scale * (to.y - from.y - 2 * padding);
  ImGui::GetWindowDrawList()->AddLine(ImVec2(from.x, y), ImVec2(to.x, y),
                                      ImGui::GetColorU32(ImGuiCol_Border));
}

}  // namespace

bool isMeasuredView(FrameRequest measured, const FrameRequest& request) {
  measured.options = request.options;
  return sameSubject(measured, request);
}

void Panel::remember(const TracedFrame& frame) {
  if (!frame.costs.empty()) {
    costs_ = frame.costs;
    measuredFor_ = frame.request;
  } else if (!isMeasuredView(measuredFor_, frame.request)) {
    costs_.clear();
  }
  if (frame.request.interruptible) return;
  constexpr std::size_t kTimes = 120;
  if (times_.size() == kTimes) times_.erase(times_.begin());
  times_.push_back(static_cast<float>(frame.stats.frameMs));
}

bool Panel::drawTabs(const TracedFrame& frame, const RayPick& pick, PanelSettings& settings,
                     const SkyChoice& ownSky, ShadingEdit& scene) const {
  bool edited = false;
  const std::string chosen = std::exchange(settings.tab, std::string());
  const auto tab = [&](const char* name, auto&& draw) {
    const bool choose = chosen == name;
    if (!ImGui::BeginTabItem(name, nullptr, choose ? ImGuiTabItemFlags_SetSelected : 0)) return;
    settings.tabShown = name;
    // The contents of a tab scroll below the row of tabs.
    const float line = ImGui::GetFontSize(), top = ImGui::GetCursorScreenPos().y;
    const float room = ImGui::GetIO().DisplaySize.y - top - 2 * line;
    ImGui::BeginChild("tab", ImVec2(0, std::max(room, 4 * line)));
    draw();
    ImGui::EndChild();
    ImGui::EndTabItem();
  };
  if (!ImGui::BeginTabBar("tabs", ImGuiTabBarFlags_FittingPolicyResizeDown)) return false;
  tab("frame", [&] {
    drawStages(frame.stats);
    drawRays(frame.stats, frame.effects);
  });
  tab("picture", [&] {
    drawPicture(settings);
    drawView(frame, settings);
  });
  tab("knobs", [&] {
    if (settings.measureKnobs) {
      ImGui::ProgressBar(static_cast<float>(frame.measured), ImVec2(-1, 0),
                         formatted("measuring: %.0f %%", 100 * frame.measured).c_str());
    } else if (ImGui::Button("measure what each costs (M)")) {
      settings.measureKnobs = true;
    }
    drawMeasured(costs_);
    drawOptions(Tab::knobs, settings.options, costs_);
  });
  tab("effects", [&] { drawEffects(frame, costs_, settings.options.disable); });
  tab("rays", [&] { drawRayTree(pick, frame, settings.rays); });
  tab("scene", [&] {
    settings.saveScene |= ImGui::Button("save as a scene file (Ctrl+S)");
    edited = drawSceneTab(ownSky, settings.rays, scene);
  });
  tab("keys", drawKeys);
  ImGui::EndTabBar();
  return edited;
}

bool Panel::draw(const TracedFrame& frame, const RayPick& pick, double speed,
                 PanelSettings& settings, const SkyChoice& ownSky, ShadingEdit& scene) const {
  constexpr float kMargin = 10, kWidth = 32;  // pixels; heights of the font
  // The panel folds in windows that are narrower, where the font has the usual height.
  constexpr float kFolds = 800, kUsualFont = 13;
  const float width = ImGui::GetFontSize() * kWidth;
  const float height = std::max(ImGui::GetIO().DisplaySize.y - 2 * kMargin, kMargin);
  ImGui::SetNextWindowPos(ImVec2(kMargin, kMargin), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, height));
  ImGui::SetNextWindowBgAlpha(kPanelAlpha);
  // In a narrow window it would hide much of the picture; the user can unfold it.
  const bool narrow = ImGui::GetIO().DisplaySize.x < kFolds * ImGui::GetFontSize() / kUsualFont;
  if (std::exchange(settings.narrow, narrow) != narrow) ImGui::SetNextWindowCollapsed(narrow);
  bool edited = false;
  if (ImGui::Begin("whit", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
    drawTimes(frame);
    drawGraph(times_, settings.rate);
    ImGui::Text("speed %.3g units a second", speed);
    edited = drawTabs(frame, pick, settings, ownSky, scene);
  }
  ImGui::End();
  return edited;
}

}  // namespace whit::view
