#include "viewer/panel.h"

#include <imgui.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "cli/frame_summary.h"
#include "viewer/keys.h"
#include "viewer/knobs.h"
#include "viewer/resolution_control.h"
#include "viewer/scene_panel.h"

namespace whit::view {

namespace {

void drawStages(const FrameStats& stats) {
  const double frame = std::max(stats.frameMs, 1e-9);
  for (std::size_t i = 0; i < kStageCount; ++i) {
    const double ms = stats.stageMs(static_cast<Stage>(i));
    char text[80];
    std::snprintf(text, sizeof text, "%s %.2f ms", kStageNames[i].data(), ms);
    // The text stands beside the bar's fill, so that both stay legible.
    const ImVec2 corner = ImGui::GetCursorPos();
    ImGui::ProgressBar(static_cast<float>(ms / frame), ImVec2(-1, 0), "");
    const ImVec2 below = ImGui::GetCursorPos();
    ImGui::SetCursorPos(ImVec2(corner.x + 6, corner.y + ImGui::GetStyle().FramePadding.y));
    ImGui::TextUnformatted(text);
    ImGui::SetCursorPos(below);
  }
}

void drawRays(const FrameStats& stats) {
  if (!ImGui::BeginTable("rays", 4)) return;
  for (const char* heading : {"rays", "thousands", "Mray/s", "lanes %"}) {
    ImGui::TableSetupColumn(heading);
  }
  ImGui::TableHeadersRow();
  for (std::size_t i = 0; i < kRayKindCount; ++i) {
    const RayTally& tally = stats.meter.tally[i];
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(kRayKindNames[i].data());
    ImGui::TableNextColumn();
    ImGui::Text("%.1f", static_cast<double>(tally.rays) / 1e3);
    ImGui::TableNextColumn();
    ImGui::Text("%.2f", cli::mraysPerSecond(tally.rays, stats.frameMs));
    ImGui::TableNextColumn();
    ImGui::Text("%.1f", 100 * cli::lanesFilled(tally));
  }
  ImGui::EndTable();
}

// A box for each effect that the scene calls for; the others grayed; why, for all of them.
void drawEffects(const TracedFrame& frame, const KnobCosts& costs, EffectSet& disable) {
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
  drawDisplay(settings.options);
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

// What is shown in the picture's stead.
void drawView(const TracedFrame& frame, PanelSettings& settings) {
  int view = static_cast<int>(settings.view), compare = static_cast<int>(settings.compare);
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 11);
  if (ImGui::Combo("view (V)", &view, kDebugViewNames.data(),
                   static_cast<int>(kDebugViewNames.size()))) {
    settings.view = static_cast<DebugView>(view);
  }
  if (!frame.legend.empty()) ImGui::TextWrapped("%s", frame.legend.c_str());
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
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(help.keys);
    ImGui::TableNextColumn();
    ImGui::TextWrapped("%s", help.text);
  }
  ImGui::EndTable();
}

constexpr ImGuiWindowFlags kLine = ImGuiWindowFlags_NoDecoration |
                                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoFocusOnAppearing;

void placeAtBottom() {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(window.x / 2, window.y - 10), ImGuiCond_Always, ImVec2(0.5f, 1));
}

}  // namespace

void Panel::remember(const TracedFrame& frame) {
  costs_.learn(frame);
  if (frame.request.interruptible) return;
  graph_.add(frame.stats.frameMs);
}

void Panel::drawTimes(const TracedFrame& frame) const {
  const FrameStats& stats = frame.stats;
  ImGui::Text("%s, %llu triangles", frame.scene->scene.name.c_str(),
              static_cast<unsigned long long>(frame.triangles));
  const Image& image = frame.film.image;
  ImGui::Text("%d x %d, %d sample%s a pixel", image.width, image.height, frame.request.spp,
              frame.request.spp == 1 ? "" : "s");
  ImGui::Text("%s, packets of %d, %d thread%s", frame.machine.simd.c_str(), frame.machine.packet,
              frame.machine.threads, frame.machine.threads == 1 ? "" : "s");
  ImGui::Text("%.2f ms traced, %.2f in Embree", stats.frameMs, stats.embreeMs());
}

bool Panel::drawTabs(const TracedFrame& frame, PanelSettings& settings, ShadingEdit& scene) const {
  bool edited = false;
  const std::string chosen = std::exchange(settings.tab, std::string());
  const auto tab = [&](const char* name, auto&& draw) {
    const bool choose = chosen == name;
    if (!ImGui::BeginTabItem(name, nullptr, choose ? ImGuiTabItemFlags_SetSelected : 0)) return;
    draw();
    ImGui::EndTabItem();
  };
  if (!ImGui::BeginTabBar("tabs")) return false;
  tab("frame", [&] {
    drawStages(frame.stats);
    drawRays(frame.stats);
  });
  tab("picture", [&] {
    drawPicture(settings);
    drawView(frame, settings);
  });
  tab("knobs", [&] {
    drawKnobs(settings.options, costs_);
    ImGui::BeginDisabled(settings.measureKnobs);
    if (ImGui::Button(settings.measureKnobs ? "measuring" : "measure what each costs (M)")) {
      settings.measureKnobs = true;
    }
    ImGui::EndDisabled();
    drawLastChange(costs_);
  });
  tab("effects", [&] { drawEffects(frame, costs_, settings.options.disable); });
  tab("scene", [&] {
    ImGui::TextDisabled("lights");
    edited |= drawLights(scene.lights);
    ImGui::TextDisabled("materials");
    edited |= drawMaterials(scene.materials);
  });
  tab("keys", drawKeys);
  ImGui::EndTabBar();
  return edited;
}

bool Panel::draw(const TracedFrame& frame, double speed, PanelSettings& settings,
                 ShadingEdit& scene) const {
  constexpr float kMargin = 10, kWidth = 29;  // pixels; heights of the font
  const float width = ImGui::GetFontSize() * kWidth;
  const float height = std::max(ImGui::GetIO().DisplaySize.y - 2 * kMargin, kMargin);
  ImGui::SetNextWindowPos(ImVec2(kMargin, kMargin), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, height));
  ImGui::SetNextWindowBgAlpha(kPanelAlpha);
  // Where it would hide most of the picture it begins as its title.
  ImGui::SetNextWindowCollapsed(ImGui::GetIO().DisplaySize.x < 1.5f * width,
                                ImGuiCond_FirstUseEver);
  bool edited = false;
  if (ImGui::Begin("whit", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
    drawTimes(frame);
    graph_.draw(settings.rate);
    ImGui::Text("speed %.3g units a second", speed);
    edited = drawTabs(frame, settings, scene);
  }
  ImGui::End();
  return edited;
}

void Panel::drawMessage(const std::string& message) {
  constexpr float kMargin = 10, kPadding = 6, kRounding = 6;
  constexpr ImU32 kText = IM_COL32(255, 255, 255, 255), kShade = IM_COL32(0, 0, 0, 190);
  const ImVec2 window = ImGui::GetIO().DisplaySize, size = ImGui::CalcTextSize(message.c_str());
  const ImVec2 at((window.x - size.x) / 2, window.y - kMargin - kPadding - size.y);
  ImDrawList& list = *ImGui::GetForegroundDrawList();  // panels would hide it
  list.AddRectFilled(ImVec2(at.x - kPadding, at.y - kPadding),
                     ImVec2(at.x + size.x + kPadding, at.y + size.y + kPadding), kShade, kRounding);
  list.AddText(at, kText, message.c_str());
}

bool Panel::drawError(const std::string& error) {
  bool open = true;
  placeAtBottom();
  if (ImGui::Begin("error", nullptr, kLine)) {
    ImGui::PushTextWrapPos(ImGui::GetIO().DisplaySize.x * 0.9f);
    ImGui::TextColored(ImVec4(1, 0.5f, 0.4f, 1), "%s", error.c_str());
    ImGui::PopTextWrapPos();
    open = !ImGui::Button("dismiss");
  }
  ImGui::End();
  return open;
}

}  // namespace whit::view
