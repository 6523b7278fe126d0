// The options of a render as sliders, boxes and lists, each with its cost.
#include <imgui.h>

#include <algorithm>
#include <array>
#include <type_traits>

#include "core/option_table.h"
#include "viewer/panel.h"
#include "viewer/session/control.h"

namespace whit::view {

namespace {

constexpr float kControlWidth = 11;  // in heights of the font

template <typename Field>
void drawChoice(const OptionSpec& spec, const Control& control, Field& field) {
  const std::string now = formatValue(spec, field);
  if (!ImGui::BeginCombo(spec.name.data(), now.c_str())) return;
  for (const std::string& word : control.choices) {
    if (ImGui::Selectable(word.c_str(), word == now)) parseValue(spec, word, field);
  }
  ImGui::EndCombo();
}

void drawNumber(const OptionSpec& spec, const Control& control, int& field) {
  const int low = static_cast<int>(control.low), high = static_cast<int>(control.high);
  int value = field;
  constexpr int kShort = 100;  // longer ranges need finer steps at their beginning
  const auto flags = ImGuiSliderFlags_AlwaysClamp |
                     (high - low > kShort ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
  if (ImGui::SliderInt(spec.name.data(), &value, low, high, "%d", flags)) field = value;
}

void drawNumber(const OptionSpec& spec, const Control& control, float& field) {
  constexpr auto kFlags = ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic;
  ImGui::SliderFloat(spec.name.data(), &field, static_cast<float>(control.low),
                     static_cast<float>(control.high), "%.1e", kFlags);
}

template <typename Field>
void drawKnob(const OptionSpec& spec, Field& field) {
  const Control control = describeControl<Field>(spec);
  if constexpr (std::is_same_v<Field, Exposure>) {
    ImGui::SliderFloat(spec.name.data(), &field.ev, static_cast<float>(control.low),
                       static_cast<float>(control.high), "%+.2f EV");
  } else if constexpr (std::is_same_v<Field, bool>) {
    ImGui::Checkbox(spec.name.data(), &field);
  } else if (control.kind == Control::Kind::choice) {
    drawChoice(spec, control, field);
  } else if constexpr (std::is_same_v<Field, int> || std::is_same_v<Field, float>) {
    drawNumber(spec, control, field);
  }
}

void drawPresets(RenderOptions& options) {
  constexpr std::array kNames{"good", "standard", "reference"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    RenderOptions preset = options;
    preset.quality = static_cast<Quality>(i);
    applyQuality(preset, {"mode"});  // the reference is too slow here

    // A button is on if the options are those that its preset would choose, whatever quality they
    // state.
    RenderOptions now = options;
    now.quality = preset.quality;

    if (i > 0) ImGui::SameLine();
    if (ImGui::RadioButton(kNames[i], now == preset)) options = preset;
  }
}

}  // namespace

void drawCost(const std::vector<KnobCost>& costs, const std::string& name) {
  const auto found =
      std::ranges::find_if(costs, [&](const KnobCost& cost) { return cost.name == name; });
  if (found == costs.end() || !found->significant()) return;

  ImGui::SameLine();
  ImGui::TextDisabled("%+.1f ms", found->ms());

  // The tooltip compares the numbers of rays with and without the setting.
  if (!ImGui::IsItemHovered()) return;
  const auto rays = [](const FrameStats& stats) { return static_cast<double>(stats.allRays()); };
  ImGui::SetTooltip("%s: %+.0f %% of the rays, against %s", name.c_str(),
                    100 * (1 - rays(found->then) / std::max(rays(found->now), 1.0)),
                    found->other.c_str());
}

void drawMeasured(const std::vector<KnobCost>& costs) {
  if (costs.empty()) return;

  const std::vector<KnobCost> told = toldFromNoise(costs);
  for (const KnobCost& cost : told) {
    ImGui::BulletText("%s: %s", cost.name.c_str(), costText(cost).c_str());
  }
  const std::size_t others = costs.size() - told.size();
  if (others > 0) ImGui::TextDisabled("%zu more make no difference above the noise", others);
}

void drawOptions(Tab tab, RenderOptions& options, const std::vector<KnobCost>& costs) {
  ImGui::PushItemWidth(ImGui::GetFontSize() * kControlWidth);
  if (tab == Tab::knobs) drawPresets(options);
  forEachOption(options, [&](const OptionSpec& spec, auto& field) {
    if (spec.tab != tab) return;

    drawKnob(spec, field);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", spec.help.data());
    drawCost(costs, std::string(spec.name));
  });
  ImGui::PopItemWidth();
}

}  // namespace whit::view
