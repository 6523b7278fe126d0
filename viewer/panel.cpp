#include "viewer/panel.h"

#include <imgui.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/text.h"
#include "output/frame_summary.h"
#include "viewer/session/resolution_control.h"

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
    drawCell("%.2f", mraysPerSecond(tally.rays, stats.frameMs));
    drawCell("%.1f", 100 * lanesFilled(tally));
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

// Draws the choice of debug view.
void drawView(PanelSettings& settings) {
  int view = static_cast<int>(settings.view);
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 11);
  if (ImGui::Combo("view (V)", &view, kDebugViewNames.data(),
                   static_cast<int>(kDebugViewNames.size()))) {
    settings.view = static_cast<DebugView>(view);
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

void drawRecent(PanelSettings& settings) {
  if (!ImGui::BeginCombo("##recent", "open a recent scene")) return;
  for (const std::string& name : settings.recent) {
    if (ImGui::Selectable(name.c_str())) settings.open = name;
  }
  ImGui::EndCombo();
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

std::vector<std::string> drawTabs(const TracedFrame& frame, const RayPick& pick,
                                  const std::vector<KnobCost>& costs, PanelSettings& settings,
                                  const Sky& ownSky, EditedScene& scene) {
  std::vector<std::string> edits;
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

  if (!ImGui::BeginTabBar("tabs", ImGuiTabBarFlags_FittingPolicyResizeDown)) return edits;

  tab("frame", [&] {
    drawStages(frame.stats);
    drawRays(frame.stats, frame.effects);
  });

  tab("picture", [&] {
    drawOptions(Tab::picture, settings.options, {});
    drawView(settings);
  });

  tab("knobs", [&] {
    if (settings.measureKnobs) {
      ImGui::ProgressBar(static_cast<float>(frame.measured), ImVec2(-1, 0),
                         formatted("measuring: %.0f %%", 100 * frame.measured).c_str());
    } else if (ImGui::Button("measure what each costs")) {
      settings.measureKnobs = true;
    }

    drawMeasured(costs);
    drawOptions(Tab::knobs, settings.options, costs);
  });

  tab("effects", [&] { drawEffects(frame, costs, settings.options.disable); });
  tab("rays", [&] { drawRayTree(pick, frame, settings.rays); });
  tab("scene", [&] {
    settings.saveScene |= ImGui::Button("save as a scene file (Ctrl+S)");
    edits = drawSceneTab(ownSky, settings.rays, scene);
  });
  tab("keys", [&] {
    drawRecent(settings);
    drawKeys();
  });

  ImGui::EndTabBar();
  return edits;
}

}  // namespace

std::vector<std::string> Panel::draw(const TracedFrame& frame, const RayPick& pick,
                                     const std::vector<KnobCost>& costs, PanelSettings& settings,
                                     const Sky& ownSky, EditedScene& scene) {
  constexpr float kMargin = 10, kWidth = 32, kLeastWidth = 12;  // pixels; heights of the font
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const float em = ImGui::GetFontSize(), height = std::max(window.y - 2 * kMargin, kMargin);
  const float widest = std::min(em * kWidth, window.x - 2 * kMargin);
  if (width_ == 0) {
    left_ = kMargin;
    width_ = widest;
  }

  // The panel moves to the wider side of a pixel that it would cover, and shrinks to fit there.
  const auto x = std::exchange(settings.keepClear, std::nullopt);
  const bool covered = x && *x > left_ - kMargin && *x < left_ + width_ + kMargin;
  if (covered) {
    const bool rightwards = *x < window.x / 2;
    const float room = (rightwards ? window.x - *x : *x) - 3 * kMargin;
    width_ = std::clamp(room, std::min(em * kLeastWidth, widest), widest);
    left_ = rightwards ? window.x - kMargin - width_ : kMargin;
  }

  ImGui::SetNextWindowPos(ImVec2(left_, kMargin), covered ? ImGuiCond_Always : ImGuiCond_Appearing);
  ImGui::SetNextWindowSizeConstraints(ImVec2(width_, 0), ImVec2(width_, height));
  ImGui::SetNextWindowBgAlpha(kPanelAlpha);

  std::vector<std::string> edits;
  if (ImGui::Begin("whit", &settings.shown, ImGuiWindowFlags_AlwaysAutoResize)) {
    drawTimes(frame);
    edits = drawTabs(frame, pick, costs, settings, ownSky, scene);
  }

  // The user may have dragged the panel, so its place is read back.
  left_ = ImGui::GetWindowPos().x;
  ImGui::End();
  return edits;
}

}  // namespace whit::view
