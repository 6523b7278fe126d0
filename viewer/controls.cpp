// The options of a render as sliders, boxes and lists, each with its cost.
#include <imgui.h>

#include <algorithm>
#include <array>

#include "core/text.h"
#include "viewer/controls.h"
#include "viewer/panel.h"
#include "viewer/session/control.h"

namespace whit::view {

namespace {

using Kind = Control::Kind;

// Draws the widget, and returns its new value if the user has changed it.
std::optional<std::string> drawChoice(const Control& control) {
  std::optional<std::string> chosen;
  if (!ImGui::BeginCombo(control.name.c_str(), control.value.c_str())) return chosen;
  for (const std::string& word : control.choices) {
    if (ImGui::Selectable(word.c_str(), word == control.value)) chosen = word;
  }
  ImGui::EndCombo();
  return chosen;
}

std::optional<std::string> drawNumber(const Control& control) {
  constexpr double kShort = 100;  // longer ranges need finer steps at their beginning
  const bool isInteger = control.kind == Kind::integer;
  const bool isLong = isInteger ? control.high - control.low > kShort : control.step == 0;
  const auto flags = ImGuiSliderFlags_AlwaysClamp |
                     (isLong ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
  const char* format = isLong ? "%.1e" : "%+.2f EV";
  if (isInteger) format = "%.0f";

  float value = 0;
  readNumber(control.value, value);
  if (!ImGui::SliderFloat(control.name.c_str(), &value, static_cast<float>(control.low),
                          static_cast<float>(control.high), format, flags)) {
    return std::nullopt;
  }
  if (isInteger) return formatted("%.0f", double{value});
  return shortest(value);
}

std::optional<std::string> drawControl(const Control& control) {
  std::optional<std::string> value;
  if (control.kind == Kind::toggle) {
    bool on = control.value == control.choices[1];
    if (ImGui::Checkbox(control.name.c_str(), &on)) value = control.choices[on ? 1 : 0];
  } else {
    value = control.kind == Kind::choice ? drawChoice(control) : drawNumber(control);
  }

  const bool hovered = ImGui::IsItemHovered() && !control.help.empty();
  if (hovered) ImGui::SetTooltip("%s", control.help.c_str());
  return value;
}

void drawPresets(const RenderOptions& options, std::vector<std::string>& said) {
  for (const std::string& name : presetNames()) {
    if (name != presetNames().front()) ImGui::SameLine();
    if (ImGui::RadioButton(name.c_str(), name == presetOf(options)))
      said.push_back("preset " + name);
  }
}

// Draws a box for each effect, grayed where the scene does not call for it, and the reason.
void drawEffects(const ViewState& state, std::vector<std::string>& said) {
  for (std::size_t i = 0; i < kEffectNames.size(); ++i) {
    const EffectReason& reason = state.shown.reasons[i];
    const std::string name(kEffectNames[i].name);

    bool on = reason.on && !state.options.disable.has(static_cast<Effect>(i));
    ImGui::BeginDisabled(!reason.on);
    if (ImGui::Checkbox(name.c_str(), &on)) said.push_back("effect " + name + (on ? " 1" : " 0"));
    ImGui::EndDisabled();

    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    drawText(reason.because);
    ImGui::PopStyleColor();
  }
}

}  // namespace

void drawCosts(const std::vector<KnobCost>& costs) {
  if (costs.empty()) return;

  const std::vector<KnobCost> told = significantCosts(costs);
  for (const KnobCost& cost : told) {
    ImGui::Bullet();
    drawText(cost.name + ": " + costText(cost));
  }
  const std::size_t others = costs.size() - told.size();
  if (others > 0) ImGui::TextWrapped("%zu more make no difference above the noise", others);
}

void drawOptions(const ViewState& state, std::vector<std::string>& said) {
  ImGui::PushItemWidth(-17 * ImGui::CalcTextSize("0").x);  // names stand behind their widgets
  drawPresets(state.options, said);

  const std::vector<Control> controls = controlsOf(state.options);
  const auto draw = [&](bool first) {
    for (const Control& control : controls) {
      if (control.first != first) continue;
      if (const auto value = drawControl(control)) {
        said.push_back("set " + control.name + " " + *value);
      }
    }
  };

  draw(true);
  const Control view = describeControl(kViewOption, state.view);
  if (const auto value = drawControl(view)) said.push_back("view " + *value);

  if (ImGui::CollapsingHeader("more options and effects")) {
    draw(false);
    drawEffects(state, said);
  }
  ImGui::PopItemWidth();
}

}  // namespace whit::view
