// What the colors of a picture of amounts stand for, as a bar with numbers.
#pragma once

#include <imgui.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "inspect/debug_view.h"

namespace whit::view {

struct ColorScale {
  // Of the share of the way along the bar, from 0 to 1; 8-bit sRGB.
  std::function<std::array<std::uint8_t, 3>(double)> color;
  struct Tick {
    double at;  // likewise
    std::string text;
  };
  std::vector<Tick> ticks;
};

// That of the map of differences, in 8-bit codes.
ColorScale differenceScale();

// That of a view that has one.
ColorScale scaleOfView(DebugView view, const AmountScale& amounts);

// Bar and numbers, as high as that, and as wide.
float heightOf(const ColorScale& scale);
void drawColorScale(const ColorScale& scale, const ImVec2& at, float width, ImDrawList& list);

}  // namespace whit::view
