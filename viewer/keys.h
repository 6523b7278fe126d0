// The help on the keys.
#pragma once

#include <span>

namespace whit::view {

struct KeyHelp {
  const char* keys;
  const char* text;
};
std::span<const KeyHelp> keyHelp();

}  // namespace whit::view
