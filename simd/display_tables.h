// Tables that make the vector sRGB encoder exact: a guess that is the code or one less, and the
// least linear value of each code to settle it. And the codes of the cheaper encoding.
#pragma once

#include <array>
#include <cstdint>

#include "core/display.h"

namespace whit::simd {

inline constexpr int kGuessBins = 4096;  // equal steps of sqrt(x)

struct DisplayTables {
  std::array<std::int32_t, kGuessBins + 1> guess;
  std::array<float, 257> least;                     // least[256] is out of reach
  std::array<std::int32_t, kSrgbSteps + 1> byStep;  // --srgb table
};

const DisplayTables& displayTables();

}  // namespace whit::simd
