#include "viewer/panel.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <optional>

#include "core/text.h"
#include "viewer/window.h"

namespace whit::view {

namespace {

constexpr ImU32 kWhite = IM_COL32(255, 255, 255, 230), kShade = IM_COL32(0, 0, 0, 150);
constexpr ImU32 kBrightWhite = IM_COL32(255, 255, 255, 255), kDarkShade = IM_COL32(0, 0, 0, 190);

// Draws words above the panels, which would hide them. The shade goes beyond the text by `margin`
// and has round corners of that radius.
void drawLabel(const ImVec2& at, const char* text, float margin = 3, ImU32 color = kWhite,
               ImU32 shade = kShade) {
  const float widest = ImGui::GetIO().DisplaySize.x;
  const ImVec2 size = ImGui::CalcTextSize(text, nullptr, false, widest);
  ImDrawList& list = *ImGui::GetForegroundDrawList();

  list.AddRectFilled(ImVec2(at.x - margin, at.y - margin),
                     ImVec2(at.x + size.x + margin, at.y + size.y + margin), shade, margin);
  list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), at, color, text, nullptr, widest);
}

// Draws a bar of colors; colorOf(share) returns the color at a share of the way along it.
template <typename ColorOf>
void drawColorBar(const ImVec2& at, float width, ImDrawList& list, const ColorOf& colorOf) {
  constexpr int kSteps = 64;
  const float step = width / kSteps;

  for (int i = 0; i < kSteps; ++i) {
    const auto c = colorOf((i + 0.5) / kSteps);
    const float x = at.x + static_cast<float>(i) * step;
    list.AddRectFilled(ImVec2(x, at.y), ImVec2(x + step, at.y + ImGui::GetFontSize()),
                       IM_COL32(c[0], c[1], c[2], 255));
  }
}

constexpr ImGuiWindowFlags kBare = ImGuiWindowFlags_NoDecoration |
                                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoFocusOnAppearing;

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

  constexpr float kMargin = 4;
  const float away = ImGui::GetFontSize();
  const ImVec2 size = ImGui::CalcTextSize(lines.c_str()), window = ImGui::GetIO().DisplaySize;

  // The text is right of and below the pointer, or on the other side where the window ends.
  const auto beside = [&](double pointer, float length, float room) {
    const auto at = static_cast<float>(pointer);
    const bool fits = at + away + length + kMargin <= room;
    return std::max(fits ? at + away : at - away - length, kMargin);
  };
  drawLabel(ImVec2(beside(pointerX, size.x, window.x), beside(pointerY, size.y, window.y)),
            lines.c_str(), kMargin, kBrightWhite, kDarkShade);
}

void drawStatus(const TracedFrame& frame, const UnfinishedFrame* next, double rate, bool raised) {
  constexpr float kMargin = 10, kPadding = 4;
  const float line = ImGui::GetFontSize() + 2 * kPadding;
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  float y = window.y - kMargin - (raised ? 2 * line : line);

  // Lines are aligned to the right and stacked upwards; draw() returns the left end of its line.
  const auto draw = [&](const std::string& text) {
    const ImVec2 at(window.x - kMargin - ImGui::CalcTextSize(text.c_str()).x, y + kPadding);
    drawLabel(at, text.c_str(), kPadding);
    y -= line;
    return at.x;
  };

  std::string text = sharpnessText(frame.request) + errorText(frame.sampleError);
  if (next) text = samplesText(*next);
  if (rate > 0) text += formatted(", %.0f frames/s", rate);
  draw(text);
  if (!frame.debug) return;

  // A debug view shows its name and its legend, and above them a bar of its colors.
  text = kDebugViewNames[static_cast<std::size_t>(frame.request.view)];
  const std::string legend = frame.debug->legend();
  const float left = draw(legend.empty() ? text : text + ": " + legend);
  if (legend.empty()) return;
  drawColorBar(ImVec2(left, y + kPadding), window.x - kMargin - left,
               *ImGui::GetForegroundDrawList(),
               [&](double share) { return colorAt(frame.request.view, share); });
}

void drawMessage(const std::string& message) {
  constexpr float kMargin = 10, kPadding = 6;
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const ImVec2 size = ImGui::CalcTextSize(message.c_str(), nullptr, false, window.x);
  drawLabel(ImVec2((window.x - size.x) / 2, window.y - kMargin - kPadding - size.y),
            message.c_str(), kPadding, kBrightWhite, kDarkShade);
}

bool drawError(const std::string& error) {
  bool open = true;
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(window.x / 2, window.y - 10), ImGuiCond_Always, ImVec2(0.5f, 1));

  if (ImGui::Begin("error", nullptr, kBare)) {
    ImGui::PushTextWrapPos(window.x * 0.9f);
    ImGui::TextColored(ImVec4(1, 0.5f, 0.4f, 1), "%s", error.c_str());
    ImGui::PopTextWrapPos();
    open = !ImGui::Button("dismiss");
  }

  ImGui::End();
  return open;
}

std::optional<std::size_t> drawCameras(const std::vector<Camera>& cameras,
                                       std::optional<std::size_t> current) {
  constexpr float kMargin = 10;
  const float right = ImGui::GetIO().DisplaySize.x - kMargin;
  ImGui::SetNextWindowPos(ImVec2(right, kMargin), ImGuiCond_Always, ImVec2(1, 0));

  std::optional<std::size_t> chosen;
  if (ImGui::Begin("cameras", nullptr, kBare)) {
    ImGui::TextDisabled("cameras (L)");
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const std::string text = formatted("%zu  %s", i + 1, cameras[i].name.c_str());
      if (ImGui::Selectable(text.c_str(), i == current)) chosen = i;
    }
  }
  ImGui::End();
  return chosen;
}

bool drawTimeline(Timeline& timeline) {
  if (!timeline.there) return false;

  const float fromBottom = 3.5f * ImGui::GetFontSize();  // messages are below
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(window.x / 2, window.y - fromBottom), ImGuiCond_Always,
                          ImVec2(0.5f, 1));
  ImGui::SetNextWindowBgAlpha(kPanelAlpha);

  bool changed = false;
  if (ImGui::Begin("timeline", nullptr, kBare)) {
    const float line = ImGui::GetFontSize();
    if (ImGui::Button(timeline.playing ? "pause" : "play", ImVec2(4 * line, 0))) {
      timeline.playing = !timeline.playing;
      changed = true;
    }

    // A time that is set by hand stops the clock.
    ImGui::SameLine();
    auto seconds = static_cast<float>(timeline.seconds);
    ImGui::SetNextItemWidth(std::max(0.3f * window.x, 6 * line));

    if (ImGui::SliderFloat("##time", &seconds, 0, static_cast<float>(timeline.length),
                           formatted("%%.2f of %.2f s", timeline.length).c_str(),
                           ImGuiSliderFlags_AlwaysClamp)) {
      timeline.seconds = static_cast<double>(seconds);
      timeline.playing = false;
      changed = true;
    }

    if (!timeline.animations.empty()) {
      ImGui::SameLine();
      ImGui::SetNextItemWidth(9 * line);
      if (ImGui::BeginCombo("##animation", timeline.animation.c_str())) {
        for (const std::string& name : timeline.animations) {
          if (!ImGui::Selectable(name.c_str(), name == timeline.animation)) continue;
          timeline.animation = name;
          timeline.another = changed = true;
        }
        ImGui::EndCombo();
      }
    }
  }

  ImGui::End();
  return changed;
}

}  // namespace whit::view
