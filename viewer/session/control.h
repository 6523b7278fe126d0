// How the window and the page let the user set an option.
#pragma once

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/option_table.h"
#include "core/options.h"

namespace whit::view {

struct Control {
  enum class Kind { none, toggle, choice, exposure, integer, real };
  Kind kind = Kind::none;
  double low = 0, high = 0;  // of numbers
  std::vector<std::string> choices;
};

template <typename Field>
Control describeControl(const OptionSpec& spec) {
  constexpr double kStops = 10, kLargestInteger = 1 << 20, kLargestReal = 1;
  const double low = std::max(spec.low, 0.0);

  if constexpr (std::is_same_v<Field, Exposure>) {
    return {Control::Kind::exposure, -kStops, kStops, {}};
  } else if constexpr (std::is_same_v<Field, bool>) {
    return {Control::Kind::toggle, 0, 0, {"off", "on"}};
  } else if (std::vector<std::string> choices = choicesOf(spec); !choices.empty()) {
    return {Control::Kind::choice, 0, 0, std::move(choices)};
  } else if constexpr (std::is_same_v<Field, int>) {
    return {Control::Kind::integer, low, std::min(spec.high, kLargestInteger), {}};
  } else if constexpr (std::is_same_v<Field, float>) {
    return {Control::Kind::real, low, std::min(spec.high, kLargestReal), {}};
  } else {
    return {};
  }
}

}  // namespace whit::view
