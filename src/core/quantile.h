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

}  // namespace whit
