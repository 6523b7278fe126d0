// A knob from a row of the table.
#pragma once

#include <algorithm>
#include <charconv>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "accuracy/knobs.h"

namespace whit::accuracy {

// Values as on the command line.
inline std::string labelOf(int value) { return std::to_string(value); }
inline std::string labelOf(bool value) { return value ? "on" : "off"; }
inline std::string labelOf(float value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}
template <typename Enum>
std::function<std::string(Enum)> named(std::vector<std::string> names) {
  return [names = std::move(names)](Enum value) { return names[static_cast<std::size_t>(value)]; };
}

template <typename T>
struct KnobRow {
  const char* name;
  T& (*field)(RenderOptions&);
  Cause cause;
  T exact;
  std::vector<T> values, joint;
  std::vector<T> spare = {};
};

template <typename T>
Knob knobOf(const KnobRow<T>& row, Idle idle, const std::function<std::string(T)>& label) {
  Knob knob{row.name, row.cause, {}, nullptr, std::move(idle)};
  const auto set = [field = row.field](const T& value) {
    return [field, value](RenderOptions& options) { field(options) = value; };
  };
  knob.makeExact = [apply = set(row.exact)](RenderOptions& o, const Exactness&) { apply(o); };
  for (const T& value : row.values) {
    const auto isIn = [&value](const std::vector<T>& values) {
      return std::find(values.begin(), values.end(), value) != values.end();
    };
    knob.values.push_back(
        {label(value), set(value), isIn(row.joint), nullptr, {}, isIn(row.spare)});
  }
  return knob;
}
template <typename T>
Knob knobOf(const KnobRow<T>& row, Idle idle) {
  return knobOf<T>(row, std::move(idle), [](T value) { return labelOf(value); });
}

}  // namespace whit::accuracy
