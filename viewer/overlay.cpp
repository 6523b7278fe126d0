#include "viewer/overlay.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <optional>

#include "core/index.h"
#include "core/option_table.h"
#include "core/text.h"
#include "viewer/panel.h"
#include "viewer/session/verbs.h"
#include "viewer/window.h"

namespace whit::view {

namespace {

// Pixels of a label around its words.
float padding() { return margin() / 2; }

// Labels are words below the panels, in lines that fit into the window.
float widestLabel() { return ImGui::GetIO().DisplaySize.x - 2 * margin(); }
ImVec2 labelSize(const std::string& text) {
  return ImGui::CalcTextSize(text.c_str(), nullptr, false, widestLabel());
}

// Draws a label on a shade that goes beyond it by padding() and has round corners of that radius.
void drawLabel(const ImVec2& at, const std::string& text) {
  const ImVec2 size = labelSize(text);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();

  list.AddRectFilled(ImVec2(at.x - padding(), at.y - padding()),
                     ImVec2(at.x + size.x + padding(), at.y + size.y + padding()),
                     IM_COL32(0, 0, 0, 190), padding());
  list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), at, IM_COL32_WHITE, text.c_str(), nullptr,
               widestLabel());
}

// Draws a bar of the colors of a debug view.
void drawColorBar(const ImVec2& at, float width, DebugView view) {
  constexpr int kSteps = 64;
  const float step = width / kSteps;

  for (int i = 0; i < kSteps; ++i) {
    const auto c = colorAt(view, (i + 0.5) / kSteps);
    const float x = at.x + static_cast<float>(i) * step;
    ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(x, at.y),
                                                  ImVec2(x + step, at.y + ImGui::GetFontSize()),
                                                  IM_COL32(c[0], c[1], c[2], 255));
  }
}

constexpr ImGuiWindowFlags kBare = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize |
                                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoFocusOnAppearing;
// Names and paths may be longer than the window is wide.
constexpr ImGuiWindowFlags kBareList = kBare | ImGuiWindowFlags_HorizontalScrollbar;

// Begins a window in the middle above `bottom`; the other function ends it and returns its top.
void beginAbove(float bottom, const char* name) {
  ImGui::SetNextWindowPos(ImVec2(ImGui::GetIO().DisplaySize.x / 2, bottom - margin()),
                          ImGuiCond_Always, ImVec2(0.5f, 1));
  ImGui::SetNextWindowBgAlpha(kPanelAlpha);
  ImGui::Begin(name, nullptr, kBare);
}

float endAbove() {
  const float top = ImGui::GetWindowPos().y;
  ImGui::End();
  return top;
}

// Returns the place in the picture, each coordinate from 0 to 1; null: beside the picture.
std::optional<std::array<double, 2>> placeIn(const ImageSize& madeFor, const ImageSize& window,
                                             const std::array<int, 2>& pixel) {
  // The picture is centered in the window and keeps its shape.
  const auto shares = sharesFilled(madeFor, window);
  const double x = ((pixel[0] + 0.5) / window.width - 0.5) / shares[0] + 0.5;
  const double y = ((pixel[1] + 0.5) / window.height - 0.5) / shares[1] + 0.5;

  if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) return std::nullopt;
  return std::array{x, y};
}

int indexAt(double share, int pixels) { return static_cast<int>(share * pixels); }

}  // namespace

std::string inspect(const TracedFrame& frame, const ImageSize& window,
                    const std::array<int, 2>& pixel) {
  const Image& image = frame.film.image;
  const ImageSize& madeFor = frame.request.window;
  if (!frame.debug) return "";

  const auto place = placeIn(madeFor, window, pixel);
  if (!place) return "";
  const auto [shareX, shareY] = *place;
  const int x = indexAt(shareX, image.width), y = indexAt(shareY, image.height);

  return formatted("pixel %d, %d\n", indexAt(shareX, madeFor.width),
                   indexAt(shareY, madeFor.height)) +
         frame.debug->textOf(image.index(x, y));
}

void drawInspection(const std::string& lines, double pointerX, double pointerY) {
  if (lines.empty()) return;

  const float away = ImGui::GetFontSize();
  const ImVec2 size = labelSize(lines), window = ImGui::GetIO().DisplaySize;

  // The text is right of and below the pointer, or on the other side where the window ends.
  const auto beside = [&](double pointer, float length, float room) {
    const auto at = static_cast<float>(pointer);
    const bool fits = at + away + length + padding() <= room;
    return std::max(fits ? at + away : at - away - length, padding());
  };
  drawLabel(ImVec2(beside(pointerX, size.x, window.x), beside(pointerY, size.y, window.y)), lines);
}

float drawStatus(const ViewState& state, float bottom) {
  const TracedFrame& frame = state.shown;
  const float right = ImGui::GetIO().DisplaySize.x - margin();

  // Labels are aligned to the right and stacked upwards; draw() returns the left end of its label.
  float top = bottom - margin();
  const auto draw = [&](const std::string& text) {
    const ImVec2 size = labelSize(text);
    top -= size.y + 2 * padding();
    drawLabel(ImVec2(right - size.x, top + padding()), text);
    return right - size.x;
  };

  draw(statusText(state));
  if (!frame.debug) return top;

  // A debug view shows its name and its legend, and above them a bar of its colors.
  const std::string name = entryOf(kDebugViewNames, frame.request.view);
  const std::string legend = frame.debug->legend();
  const float left = draw(legend.empty() ? name : name + ": " + legend);
  if (legend.empty()) return top;

  top -= ImGui::GetFontSize() + 2 * padding();
  drawColorBar(ImVec2(left, top + padding()), right - left, frame.request.view);
  return top;
}

float drawMessage(const std::string& message, float bottom) {
  const ImVec2 size = labelSize(message);
  const float top = bottom - margin() - padding() - size.y;
  drawLabel(ImVec2((ImGui::GetIO().DisplaySize.x - size.x) / 2, top), message);
  return top - padding();
}

float drawError(const std::string& error, float bottom, std::vector<std::string>& said) {
  beginAbove(bottom, "error");
  ImGui::PushTextWrapPos(ImGui::GetIO().DisplaySize.x * 0.9f);
  ImGui::TextColored(ImVec4(1, 0.5f, 0.4f, 1), "%s", error.c_str());
  ImGui::PopTextWrapPos();
  if (ImGui::Button("dismiss")) said.emplace_back("dismiss");
  return endAbove();
}

void drawScenes(const std::vector<std::string>& recent, std::vector<std::string>& said) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const float room = std::max(window.y - 8 * margin(), margin());
  ImGui::SetNextWindowPos(ImVec2(window.x / 2, margin()), ImGuiCond_Always, ImVec2(0.5f, 0));
  ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), ImVec2(window.x - 2 * margin(), room));

  ImGui::Begin("scenes", nullptr, kBareList);
  ImGui::TextUnformatted("Choose a scene, or drop a file here");
  const auto draw = [&](const char* title, const std::vector<std::string>& names) {
    if (names.empty()) return;
    ImGui::TextDisabled("%s", title);
    ImGui::PushID(title);  // both lists may have the same name
    for (const std::string& name : names) {
      if (ImGui::Selectable(name.c_str())) said.push_back("open " + name);
    }
    ImGui::PopID();
  };
  draw("opened lately", recent);
  draw("shipped", shippedNames());
  ImGui::End();
}

void drawCameras(const ViewState& state, std::vector<std::string>& said) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(window.x - margin(), margin()), ImGuiCond_Always, ImVec2(1, 0));
  ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0),
                                      ImVec2(window.x - 2 * margin(), window.y - 2 * margin()));

  ImGui::Begin("cameras", nullptr, kBareList);
  ImGui::TextDisabled("cameras (L)");
  const std::vector<Camera>& cameras = state.scene->scene.cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::string text = formatted("%zu  %s", i + 1, cameras[i].name.c_str());
    if (ImGui::Selectable(text.c_str(), i == state.followed)) {
      said.push_back(formatted("camera %zu", i));
    }
  }
  ImGui::End();
}

void drawKeys(float bottom) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const float width = std::min(58 * ImGui::GetFontSize(), window.x - 2 * margin());
  ImGui::SetNextWindowPos(ImVec2(window.x / 2, margin()), ImGuiCond_Always, ImVec2(0.5f, 0));
  ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, bottom - 2 * margin()));
  ImGui::SetNextWindowBgAlpha(kPanelAlpha);

  ImGui::Begin("keys", nullptr, kBare);
  if (ImGui::BeginTable("keys", 2)) {
    ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthStretch, 1);
    ImGui::TableSetupColumn("what they do", ImGuiTableColumnFlags_WidthStretch, 2);
    for (const Verb& verb : verbs()) {
      if (verb.keys.empty()) continue;
      for (const std::string_view text : {verb.keys, verb.help}) {
        ImGui::TableNextColumn();
        drawText(std::string(text));
      }
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

float drawTimeline(const Timeline& timeline, float bottom, std::vector<std::string>& said) {
  if (!timeline.there) return bottom;

  beginAbove(bottom, "timeline");
  const float line = ImGui::GetFontSize();
  if (ImGui::Button(timeline.playing ? "pause" : "play", ImVec2(4 * line, 0))) {
    said.emplace_back("play");
  }

  ImGui::SameLine();
  auto seconds = static_cast<float>(timeline.seconds);
  ImGui::SetNextItemWidth(std::max(0.3f * ImGui::GetIO().DisplaySize.x, 6 * line));
  if (ImGui::SliderFloat("##time", &seconds, 0, static_cast<float>(timeline.length),
                         formatted("%%.2f of %.2f s", timeline.length).c_str(),
                         ImGuiSliderFlags_AlwaysClamp)) {
    said.push_back("time " + shortest(seconds));
  }

  if (!timeline.animations.empty()) {
    ImGui::SameLine();
    ImGui::SetNextItemWidth(9 * line);
    if (ImGui::BeginCombo("##animation", timeline.animation.c_str())) {
      for (const std::string& name : timeline.animations) {
        const bool current = name == timeline.animation;
        if (ImGui::Selectable(name.c_str(), current)) said.push_back("animation " + name);
      }
      ImGui::EndCombo();
    }
  }
  return endAbove();
}

}  // namespace whit::view
