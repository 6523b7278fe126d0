#include "accuracy/median_interval.h"

#include <algorithm>
#include <cmath>

namespace whit::accuracy {

namespace {

// How many values can be left out at either end. The median of the distribution is beyond what is
// left there with P(Binomial(n, 1/2) <= spare), which may be half of what the confidence leaves.
std::size_t spareValues(std::size_t n) {
  // In logarithms: 2^-n is 0 for the thousands of frames that a baseline has.
  double logTerm = -static_cast<double>(n) * std::log(2.0), below = 0;  // P(X = k), P(X < k)
  std::size_t k = 0;
  while (below + std::exp(logTerm) <= (1 - kMedianConfidence) / 2) {
    below += std::exp(logTerm);
    logTerm += std::log(static_cast<double>(n - k) / static_cast<double>(k + 1));
    ++k;
  }
  return k == 0 ? 0 : k - 1;
}

}  // namespace

Interval medianInterval(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t spare = spareValues(values.size());
  return {values[spare], values[values.size() - 1 - spare]};
}

}  // namespace whit::accuracy
