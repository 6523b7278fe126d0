#include "inspect/value_difference.h"

#include <algorithm>
#include <cmath>

namespace whit {

ValueDifference differenceOf(std::span<const float> a, std::span<const float> b) {
  ValueDifference result;
  double squares = 0;
  std::uint64_t compared = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool finite = std::isfinite(a[i]) && std::isfinite(b[i]);
    const bool equal = a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i]));
    result.differing += !equal;
    result.incomparable += !equal && !finite;
    if (!finite) continue;
    const double difference = std::abs(double{a[i]} - double{b[i]});
    result.largest = std::max(result.largest, difference);
    squares += difference * difference;
    ++compared;
  }
  if (compared > 0) result.rms = std::sqrt(squares / static_cast<double>(compared));
  return result;
}

ValueDifference differenceOf(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
  ValueDifference result;
  for (std::size_t i = 0; i < a.size(); ++i) result.differing += a[i] != b[i];
  return result;
}

}  // namespace whit
