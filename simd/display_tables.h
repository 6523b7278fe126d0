// Tables that make the vector sRGB encoder exact: a guess that is the code or one less, and the
// least linear value of each code to settle it.
#pragma once

#include <array>
#include <cstdint>

namespace whit::simd {

inline constexpr int kGuessBins = 4096;  // equal steps of sqrt(x)

struct DisplayTables {
  std::array<std::int32_t, kGuessBins + 1> guess;
  std::array<float, 257> least;  // least[256] is out of reach
};

const DisplayTables& displayTables();

}  // namespace whit::simd
