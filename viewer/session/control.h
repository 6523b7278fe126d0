// How the window and the page let the user set an option.
#pragma once

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

#include "core/option_table.h"
#include "core/options.h"

namespace whit::view {

struct Control {
  enum class Kind { none, toggle, choice, integer, real };
  Kind kind = Kind::none;
  std::string name, help, value;
  bool first = false;                // among the options that change a picture most
  double low = 0, high = 0;          // range of a number
  double step = 0;                   // step of a number; 0: any
  std::vector<std::string> choices;  // toggles have two
};

// Returns a control of kind `none` if the option is set by commands only.
template <typename Field>
Control describeControl(const OptionSpec& spec, const Field& field) {
  constexpr double kStops = 10, kLargestInteger = 1 << 20, kLargestReal = 1;

  Control control;
  control.name = spec.name;
  control.help = spec.help;
  control.value = formatValue(spec, field);
  control.choices = choicesOf(spec);
  control.low = std::max(spec.low, 0.0);

  if constexpr (std::is_same_v<Field, Exposure>) {
    control.kind = Control::Kind::real;
    control.low = -kStops;
    control.high = kStops;
    control.step = 0.25;
    control.choices.clear();
  } else if constexpr (std::is_same_v<Field, bool>) {
    control.kind = Control::Kind::toggle;
    control.choices = {"off", "on"};
  } else if (!control.choices.empty()) {
    control.kind = Control::Kind::choice;
  } else if constexpr (std::is_same_v<Field, int>) {
    control.kind = Control::Kind::integer;
    control.high = std::min(spec.high, kLargestInteger);
    control.step = 1;
  } else if constexpr (std::is_same_v<Field, float>) {
    control.kind = Control::Kind::real;
    control.high = std::min(spec.high, kLargestReal);
  }
  return control;
}

// Returns the controls of all options that viewers can set, in the order of the table of options.
std::vector<Control> controlsOf(const RenderOptions& options);

// Returns the names of the presets.
const std::vector<std::string>& presetNames();
// Returns the preset that would choose these options, whatever quality they state; empty: none.
std::string presetOf(const RenderOptions& options);
// Sets the options that the preset chooses.
void applyPreset(const std::string& name, RenderOptions& options);

}  // namespace whit::view
