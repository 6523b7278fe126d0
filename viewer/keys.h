// Keys by name, for scripts and for the help.
#pragma once

#include <span>
#include <string>

namespace whit::view {

// The GLFW code of "W", "7", "F12", "Left", "Shift", "Space", "+", "["...; throws Error(usage)
// naming the nearest.
int keyNamed(const std::string& name);

struct KeyHelp {
  const char* keys;
  const char* text;
};
std::span<const KeyHelp> keyHelp();

}  // namespace whit::view
