// For each mask of up to eight lanes, the numbers of its live lanes, in order.
#pragma once

#include <array>
#include <cstdint>

namespace whit::simd {

using CompactOrders = std::array<std::array<std::uint8_t, 8>, 256>;

constexpr CompactOrders makeCompactOrders() {
  CompactOrders orders{};
  for (unsigned mask = 0; mask < 256; ++mask) {
    unsigned next = 0;
    for (unsigned lane = 0; lane < 8; ++lane) {
      if ((mask >> lane & 1u) != 0) orders[mask][next++] = static_cast<std::uint8_t>(lane);
    }
  }
  return orders;
}

alignas(64) inline constexpr CompactOrders kCompactOrder = makeCompactOrders();

}  // namespace whit::simd
