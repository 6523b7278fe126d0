#include "viewer/ray_panel.h"
#include "viewer/panel.h"
#include "viewer/window.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "core/text.h"

namespace whit::view {

namespace {

constexpr double kLeastUnfolded = 0.05;  // share of the pixel's radiance

ImU32 packedColor(RayLook look) {
  const auto& c = styleOf(look).color;
  return IM_COL32(c[0], c[1], c[2], 255);
}

// The text has the color of the ray's line, but lighter.
ImVec4 textColorOf(RayKind kind) {
  const ImVec4 color = ImGui::ColorConvertU32ToFloat4(packedColor(RayLook{kind}));
  const auto lighter = [](float code) { return 0.25f + 0.75f * code; };
  return {lighter(color.x), lighter(color.y), lighter(color.z), 1};
}

// Names the colors of the lines that are drawn.
void drawLegend(const std::vector<RayLine>& lines) {
  const float side = ImGui::GetFontSize();
  bool first = true;
  for (const RayLook look : looksOf(lines)) {
    const std::string name(styleOf(look).name);
    const float width =
        side + ImGui::CalcTextSize(name.c_str()).x + ImGui::GetStyle().ItemSpacing.x;

    // A color that does not fit into the line begins the next one.
    if (!first) {
      ImGui::SameLine();
      if (ImGui::GetContentRegionAvail().x < width) ImGui::NewLine();
    }
    first = false;

    ImGui::ColorButton(name.c_str(), ImGui::ColorConvertU32ToFloat4(packedColor(look)),
                       ImGuiColorEditFlags_NoTooltip, ImVec2(side, side));
    ImGui::SameLine();
    ImGui::TextUnformatted(name.c_str());
  }
}

class RayTreeTab {
 public:
  RayTreeTab(const RayPick& pick, const RenderOptions& options)
      : pick_(pick), tree_(pick.rays.packets), options_(options) {}

  // Returns the ray that the pointer is on.
  std::size_t draw(bool& lines, std::vector<std::string>& said) {
    drawPixel();
    if (ImGui::Button("look from aside")) said.emplace_back("aside");
    ImGui::SameLine();
    ImGui::Checkbox("lines", &lines);
    ImGui::SameLine();
    if (ImGui::Button("forget")) said.emplace_back("forget");

    if (lines) drawLegend(pick_.lines);
    for (const std::size_t primary : tree_.primaries) drawNode(primary);
    return pointedAt_;
  }

 private:
  void drawPixel() const {
    const ImageSize size = pick_.query.picture.options.size.value();
    ImGui::Text("pixel %d,%d of %dx%d", pick_.query.x, pick_.query.y, size.width, size.height);

    const auto draw = [&](const char* name, const Rgb& pixel) {
      const auto codes = codesOf(pixel, options_);
      drawText(formatted("%s %s, codes %d %d %d", name, textOf(RgbD(pixel)).c_str(), codes[0],
                         codes[1], codes[2]));
    };

    // Both renderers trace the pixel, so that a difference between them shows.
    draw("packets", tree_.pixel);
    draw("reference", pick_.rays.reference.pixel);
    ImGui::Text("rays: %zu, shadow rays: %zu", tree_.nodes.size(), tree_.shadowRays());
  }

  void point(std::size_t node) {
    if (ImGui::IsItemHovered()) pointedAt_ = node;
  }

  void drawNode(std::size_t number) {
    const RayNode& n = tree_.nodes[number];

    // Rays that add a noticeable share to the pixel begin unfolded.
    const RgbD added = contributionOf(tree_, number, n.radiance);
    const double share = maxComponent(added) / std::max(1e-12, double{maxComponent(tree_.pixel)});

    ImGui::PushID(static_cast<int>(number));
    ImGui::SetNextItemOpen(share >= kLeastUnfolded, ImGuiCond_Once);
    ImGui::PushStyleColor(ImGuiCol_Text, textColorOf(n.kind));

    // The text wraps, which that of a node does not.
    const bool open = ImGui::TreeNodeEx("node", ImGuiTreeNodeFlags_SpanFullWidth, "%s", "");
    point(number);
    ImGui::SameLine();
    drawText(formatted("%s: %s, %d codes", rowOf(n.kind).name.data(),
                       pick_.words[number].hit.c_str(), codesAddedBy(tree_, number, options_)));
    ImGui::PopStyleColor();

    if (open) {
      drawOwn(number);
      for (const std::size_t child : n.children) drawNode(child);
      ImGui::TreePop();
    }
    ImGui::PopID();
  }

  void drawOwn(std::size_t number) {
    const RayText& words = pick_.words[number];
    const auto draw = [&](const std::string& line) {
      ImGui::Bullet();
      drawText(line);
      point(number);
    };

    draw("weight " + textOf(tree_.nodes[number].weight) + ", in " + words.medium);
    for (const std::string& line : words.lines) draw(line);
  }

  const RayPick& pick_;
  const RayTree& tree_;
  const RenderOptions& options_;
  std::size_t pointedAt_ = kNoCounterpart;
};

void drawDashed(ImDrawList& list, const ScreenLine& l, ImU32 color, float width, double scale) {
  const double dash = 5 * scale, period = 9 * scale;  // pixels
  const double length = std::hypot(l.x2 - l.x1, l.y2 - l.y1);
  if (!(length > 0)) return;

  const double dx = (l.x2 - l.x1) / length, dy = (l.y2 - l.y1) / length;
  const auto at = [&](double way) {
    return ImVec2(static_cast<float>(l.x1 + way * dx), static_cast<float>(l.y1 + way * dy));
  };

  for (int i = 0; i * period < length; ++i) {
    const double begin = i * period;
    list.AddLine(at(begin), at(std::min(begin + dash, length)), color, width);
  }
}

}  // namespace

std::size_t drawRayTree(const ViewState& state, bool& lines, std::vector<std::string>& said) {
  if (!state.rays.scene) {
    drawText(
        "Click on the picture: the rays of that pixel are listed here and drawn into the scene.");
    return kNoCounterpart;
  }
  return RayTreeTab(state.rays, state.shown.request.options).draw(lines, said);
}

void drawRayLines(const RayPick& pick, const Camera& camera, std::size_t pointedAt) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  if (!pick.scene || window.x < 1 || window.y < 1) return;

  const LineView seen(camera, static_cast<int>(window.x), static_cast<int>(window.y));
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float scale = ImGui::GetFontSize() / kFontHeight;

  const auto draw = [&](const RayLine& line, double extra) {
    auto at = seen.see(line.from, line.to);
    if (!at || !clip(*at, double{window.x}, double{window.y})) return;

    const auto width = static_cast<float>(line.width + extra) * scale;
    const ImU32 color = packedColor(line.look);

    if (isDashed(line.look)) {
      drawDashed(list, *at, color, width + 0.5f * scale, scale);
      return;
    }

    const ImVec2 from(static_cast<float>(at->x1), static_cast<float>(at->y1));
    const ImVec2 to(static_cast<float>(at->x2), static_cast<float>(at->y2));
    list.AddLine(from, to, IM_COL32(0, 0, 0, 120),
                 width + 2 * scale);  // legible on bright ground, too
    list.AddLine(from, to, color, width);
    list.AddCircleFilled(to, width + scale, color);
  };
  for (const RayLine& line : pick.lines) draw(line, line.node == pointedAt ? 3 : 0);
}

}  // namespace whit::view
