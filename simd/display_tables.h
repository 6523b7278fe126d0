// What makes the vector sRGB encoder exact, the least linear value of each code, and the codes of
// the cheaper encoding.
#pragma once

#include <array>
#include <cstdint>

#include "core/display.h"

namespace whit::simd {

struct DisplayTables {
  std::array<float, 257> least;                     // least[256] is out of reach
  std::array<std::int32_t, kSrgbSteps + 1> byStep;  // --srgb table
};

const DisplayTables& displayTables();

}  // namespace whit::simd
