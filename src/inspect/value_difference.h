// Measures of the difference between two columns of values, a pixel each.
#pragma once

#include <cstdint>
#include <span>

namespace whit {

struct ValueDifference {
  std::uint64_t differing = 0;     // pixels whose values are not equal; two NaN are
  std::uint64_t incomparable = 0;  // of them those where a value is not finite
  double largest = 0, rms = 0;     // of the differences of all others; 0 of numbers
};

// Both have the same length.
ValueDifference differenceOf(std::span<const float> a, std::span<const float> b);
ValueDifference differenceOf(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b);

}  // namespace whit
