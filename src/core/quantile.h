// Order statistics of measurements.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace whit {

// The value at rank ceil(share * n) of the sorted values (nearest rank); `share` in (0, 1]. 0 for
// no values.
inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;

  const double rank = std::ceil(share * static_cast<double>(values.size()));
  const auto index = static_cast<std::size_t>(std::max(rank, 1.0)) - 1;
  const auto at = values.begin() + std::min(index, values.size() - 1);

  // A partial sort finds one order statistic in linear time on average.
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Bounds between which the true median lies with a probability of 95 % or more (those of the sign
// test, by the normal approximation of the binomial distribution); of fewer than six values the
// least and the largest. Both are 0 for no values.
struct Interval {
  double low = 0, high = 0;
};
inline Interval medianInterval(std::vector<double> values) {
  if (values.empty()) return {};

  std::ranges::sort(values);
  const auto n = static_cast<double>(values.size());
  const double rank = std::max(std::floor((n - 1.96 * std::sqrt(n)) / 2), 1.0);
  const auto below = static_cast<std::size_t>(rank) - 1;
  return {values[below], values[values.size() - 1 - below]};
}

}  // namespace whit
