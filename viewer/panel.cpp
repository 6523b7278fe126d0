#include "viewer/panel.h"

#include <imgui.h>

#include <algorithm>
#include <utility>

#include "core/text.h"
#include "output/frame_summary.h"
#include "viewer/controls.h"
#include "viewer/ray_panel.h"
#include "viewer/scene_panel.h"

namespace whit::view {

namespace {

constexpr float kWidth = 32, kLeastWidth = 22;  // in heights of the font

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
  ImGui::TableSetupColumn("rays", ImGuiTableColumnFlags_WidthStretch);
  for (const char* heading : {"1000s", "Mray/s", "lanes %"}) {
    ImGui::TableSetupColumn(heading, ImGuiTableColumnFlags_WidthFixed);
  }
  ImGui::TableHeadersRow();

  for (std::size_t i = 0; i < kRayKindCount; ++i) {
    if (!kRayKinds[i].calledForBy(effects)) continue;

    const RayTally& tally = stats.meter.tally[i];
    ImGui::TableNextColumn();
    drawText(std::string(kRayKinds[i].name));
    for (const double number :
         {static_cast<double>(tally.rays) / 1e3, mraysPerSecond(tally.rays, stats.frameMs),
          100 * lanesFilled(tally)}) {
      ImGui::TableNextColumn();
      ImGui::Text("%.1f", number);
    }
  }
  ImGui::EndTable();
}

// Shows where the time of the frame went.
void drawTime(const ViewState& state, std::vector<std::string>& said) {
  const TracedFrame& frame = state.shown;
  if (state.measures) {
    ImGui::ProgressBar(static_cast<float>(frame.measured), ImVec2(-1, 0),
                       formatted("measuring: %.0f %%", 100 * frame.measured).c_str());
  } else if (ImGui::Button("measure what each option costs")) {
    said.emplace_back("measure");
  }
  drawCosts(state.costs);

  const Image& image = frame.film.image;
  drawText(aboutText(frame));
  drawText(formatted("%d x %d, %d sample%s a pixel%s; %.2f ms traced, %.2f in Embree", image.width,
                     image.height, frame.request.spp, frame.request.spp == 1 ? "" : "s",
                     errorText(frame.sampleError).c_str(), frame.stats.frameMs,
                     frame.stats.embreeMs()));
  drawStages(frame.stats);
  drawRays(frame.stats, frame.effects);
}

void drawFiles(const std::vector<std::string>& recent, std::vector<std::string>& said) {
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##recent", "open a recent scene")) {
    for (const std::string& name : recent) {
      if (ImGui::Selectable(name.c_str())) said.push_back("open " + name);
    }
    ImGui::EndCombo();
  }
  if (ImGui::Button("save as a scene file")) said.emplace_back("save-scene");
  ImGui::SameLine();
  if (ImGui::Button("undo")) said.emplace_back("undo");
}

// Draws the row of tabs.
void drawTabs(std::string& chosen) {
  for (const char* tab : kPanelTabs) {
    if (tab != kPanelTabs.front()) ImGui::SameLine();
    const bool isChosen = chosen == tab;
    ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(isChosen ? ImGuiCol_TabActive
                                                                             : ImGuiCol_FrameBg));
    if (ImGui::Button(tab)) chosen = tab;
    ImGui::PopStyleColor();
  }
  ImGui::Separator();
}

}  // namespace

float margin() { return ImGui::GetStyle().WindowPadding.x; }

// Dear ImGui alone would break lines after periods as well, and so within numbers and file names.
void drawText(const std::string& text) {
  // All letters have the same width.
  const float columns = ImGui::GetContentRegionAvail().x / ImGui::CalcTextSize("0").x;
  std::string lines = wrapped(text, 0, 0, static_cast<std::size_t>(std::max(columns, 1.0f)));
  lines.pop_back();  // the end of the last line
  ImGui::TextWrapped("%s", lines.c_str());
}

// Moves the panel beside the point that was clicked, if it could cover that: to the wider side, or
// in a narrow window above or below. Returns whether it moves.
bool Panel::place(float bottom) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const float em = ImGui::GetFontSize(), widest = std::min(em * kWidth, window.x - 2 * margin());
  if (width_ == 0) {
    left_ = top_ = margin();
    width_ = widest;
  }

  const float left = left_, top = top_;
  const auto clear = std::exchange(clear_, std::nullopt);
  if (clear && clear->x > left_ - margin() && clear->x < left_ + width_ + margin()) {
    const bool rightwards = clear->x < window.x / 2;
    const bool above = clear->y > window.y / 2;
    const float room = (rightwards ? window.x - clear->x : clear->x) - 3 * margin();
    const bool beside = room >= em * kLeastWidth;

    width_ = beside ? std::min(room, widest) : widest;
    left_ = rightwards ? window.x - margin() - width_ : margin();
    top_ = beside || above ? margin() : clear->y + 2 * margin();
    lowest_ = beside || !above ? window.y : clear->y - margin();
  }

  // It stays in the window, and ends above what is drawn at the bottom.
  const float least = 4 * em;
  width_ = std::min(width_, widest);
  left_ = std::clamp(left_, 0.0f, std::max(window.x - width_, 0.0f));
  top_ = std::clamp(top_, 0.0f, std::max(window.y - least, 0.0f));
  height_ = std::max(std::min(bottom, lowest_) - margin() - top_, least);
  return left_ != left || top_ != top;
}

SceneChange Panel::drawTab(const ViewState& state, WindowState& shown,
                           std::vector<std::string>& said) {
  SceneChange change;
  pointedAt_ = kNoCounterpart;
  if (shown.tab == "rays") {
    pointedAt_ = drawRayTree(state, shown.lines, said);
  } else if (shown.tab == "scene") {
    drawFiles(shown.recent, said);
    change.edited = state.edited;
    change.settings = drawScene(state.ownSky, unfolds_, change.edited);
  } else if (shown.tab == "time") {
    drawTime(state, said);
  } else {
    drawOptions(state, said);
  }
  return change;
}

SceneChange Panel::draw(const ViewState& state, float bottom, WindowState& shown,
                        std::vector<std::string>& said) {
  if (std::exchange(selections_, state.selections) != state.selections) unfolds_ = state.selected;

  const bool moves = place(bottom);
  ImGui::SetNextWindowPos(ImVec2(left_, top_), moves ? ImGuiCond_Always : ImGuiCond_Appearing);
  ImGui::SetNextWindowSizeConstraints(ImVec2(width_, 0), ImVec2(width_, height_));
  ImGui::SetNextWindowBgAlpha(kPanelAlpha);

  SceneChange change;
  bool open = true;
  if (ImGui::Begin("whit", &open, ImGuiWindowFlags_AlwaysAutoResize)) {
    drawTabs(shown.tab);

    // The tab is as high as its contents, and scrolls if the window is lower.
    const float line = ImGui::GetFontSize();
    const float room = top_ + height_ - ImGui::GetCursorScreenPos().y - line;
    ImGui::BeginChild(shown.tab.c_str(), ImVec2(0, std::max(std::min(room, contents_), line)));
    change = drawTab(state, shown, said);
    contents_ = ImGui::GetCursorPosY();
    ImGui::EndChild();
  }

  // The user may have dragged the panel, so its place is read back.
  left_ = ImGui::GetWindowPos().x;
  top_ = ImGui::GetWindowPos().y;
  ImGui::End();
  if (!open) shown.over = Over::nothing;
  return change;
}

}  // namespace whit::view
