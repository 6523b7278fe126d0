// The options of a render as sliders, boxes and lists, with what each has cost.
#include <imgui.h>

#include <algorithm>
#include <array>
#include <type_traits>

#include "core/option_table.h"
#include "core/option_values.h"
#include "viewer/panel.h"

namespace whit::view {

namespace {

constexpr float kControlWidth = 11;  // in heights of the font

template <typename Field>
void drawChoice(const OptionSpec& spec, Field& field) {
  const std::string now = formatValue(spec, field);
  if (!ImGui::BeginCombo(spec.name.data(), now.c_str())) return;
  for (const std::string& word : choicesOf(spec)) {
    if (ImGui::Selectable(word.c_str(), word == now)) parseValue(spec, word, field);
  }
  ImGui::EndCombo();
}

void drawNumber(const OptionSpec& spec, int& field) {
  constexpr double kOpenEnd = 1 << 20;
  const int low = static_cast<int>(std::max(spec.low, 0.0));
  const int high = static_cast<int>(std::min(spec.high, kOpenEnd));
  int value = field;
  constexpr int kShort = 100;  // longer ranges need finer steps at their beginning
  const auto flags = ImGuiSliderFlags_AlwaysClamp |
                     (high - low > kShort ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
  if (ImGui::SliderInt(spec.name.data(), &value, low, high, "%d", flags)) field = value;
}

void drawNumber(const OptionSpec& spec, float& field) {
  const auto low = static_cast<float>(std::max(spec.low, 0.0));
  const auto high = static_cast<float>(std::min(spec.high, 1.0));
  constexpr auto kFlags = ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic;
  ImGui::SliderFloat(spec.name.data(), &field, low, high, "%.1e", kFlags);
}

template <typename Field>
void drawKnob(const OptionSpec& spec, Field& field) {
  if constexpr (std::is_same_v<Field, bool>) {
    ImGui::Checkbox(spec.name.data(), &field);
  } else if (!choicesOf(spec).empty()) {
    drawChoice(spec, field);
  } else if constexpr (std::is_same_v<Field, int> || std::is_same_v<Field, float>) {
    drawNumber(spec, field);
  }
}

// What the preset makes of the options. Its reference mode is another key's matter.
RenderOptions withQuality(RenderOptions options, Quality quality) {
  options.quality = quality;
  applyQuality(options, {"mode"});
  return options;
}

void drawPresets(RenderOptions& options) {
  constexpr std::array kNames{"draft", "standard", "fine", "reference"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const RenderOptions preset = withQuality(options, static_cast<Quality>(i));
    RenderOptions now = options;
    now.quality = preset.quality;
    if (i > 0) ImGui::SameLine();
    if (ImGui::RadioButton(kNames[i], now == preset)) options = preset;
  }
}

}  // namespace

void drawCost(const KnobCosts& costs, const std::string& name) {
  const KnobCost* measured = costs.measured(name);
  const auto found = costs.changes().find(name);
  if (!measured && found == costs.changes().end()) return;
  if (measured) {
    if (!measured->significant()) return;
    ImGui::SameLine();
    ImGui::TextDisabled("%+.1f ms", measured->ms());
    if (ImGui::IsItemHovered()) {
      ImGui::SetTooltip("%s: %+.0f rays, against %s", name.c_str(), measured->rays(),
                        measured->other.c_str());
    }
    return;
  }
  const KnobChange& change = found->second;
  ImGui::SameLine();
  ImGui::TextDisabled("%+.2f ms", change.after.frameMs - change.before.frameMs);
  if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip("%s: from %s to %s", name.c_str(), change.from.c_str(), change.to.c_str());
  }
}

void drawMeasured(const KnobCosts& costs) {
  if (costs.measured().empty()) return;
  const std::vector<KnobCost> told = toldFromNoise(costs.measured());
  for (const KnobCost& cost : told) {
    ImGui::BulletText("%s: %s", cost.name.c_str(), costText(cost).c_str());
  }
  const std::size_t others = costs.measured().size() - told.size();
  if (others > 0) ImGui::TextDisabled("%zu more make no difference above the noise", others);
}

void drawKnobs(RenderOptions& options, const KnobCosts& costs) {
  drawPresets(options);
  ImGui::PushItemWidth(ImGui::GetFontSize() * kControlWidth);
  forEachOption(options, [&](const OptionSpec& spec, auto& field) {
    if (spec.tab != Tab::knobs) return;
    drawKnob(spec, field);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", spec.help.data());
    drawCost(costs, std::string(spec.name));
  });
  ImGui::PopItemWidth();
}

void drawDisplay(RenderOptions& options) {
  constexpr float kStops = 10;
  ImGui::PushItemWidth(ImGui::GetFontSize() * kControlWidth);
  forEachOption(options, [&](const OptionSpec& spec, auto& field) {
    if (spec.tab != Tab::picture) return;
    if constexpr (std::is_same_v<decltype(field), Exposure&>) {
      ImGui::SliderFloat(spec.name.data(), &field.ev, -kStops, kStops, "%+.2f EV");
    } else {
      drawKnob(spec, field);
    }
  });
  ImGui::PopItemWidth();
}

void drawLastChange(const KnobCosts& costs) {
  if (costs.lastChanged().empty()) return;
  const KnobChange& change = costs.changes().at(costs.lastChanged());
  ImGui::TextWrapped("%s: %s to %s", costs.lastChanged().c_str(), change.from.c_str(),
                     change.to.c_str());
  if (!ImGui::BeginTable("change", 4)) return;
  for (const char* heading : {"", "before", "after", "%"}) ImGui::TableSetupColumn(heading);
  ImGui::TableHeadersRow();
  const auto row = [](const char* name, double before, double after) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(name);
    ImGui::TableNextColumn();
    ImGui::Text("%.2f", before);
    ImGui::TableNextColumn();
    ImGui::Text("%.2f", after);
    ImGui::TableNextColumn();
    if (before > 0) ImGui::Text("%+.1f", 100 * (after / before - 1));
  };
  row("frame, ms", change.before.frameMs, change.after.frameMs);
  for (std::size_t i = 0; i < kRayKindCount; ++i) {
    const auto thousands = [&](const FrameStats& s) {
      return static_cast<double>(s.meter.tally[i].rays) / 1e3;
    };
    if (change.before.meter.tally[i].rays + change.after.meter.tally[i].rays == 0) continue;
    row((std::string(kRayKinds[i].name) + ", k").c_str(), thousands(change.before),
        thousands(change.after));
  }
  ImGui::EndTable();
}

}  // namespace whit::view
