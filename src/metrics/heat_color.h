// The colors of heat maps.
#pragma once

#include <array>
#include <cstdint>

namespace whit {

// From black over violet and orange to a light yellow, lightness growing all the way. `t` in
// [0, 1]; 8-bit sRGB.
std::array<std::uint8_t, 3> heatColor(double t);

}  // namespace whit
