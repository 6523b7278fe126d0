// Where the median of what was sampled lies, whatever its distribution.
#pragma once

#include <vector>

namespace whit::accuracy {

struct Interval {
  double low = 0, high = 0;
};

// The confidence that five values, the fewest, allow: the median of their distribution is outside
// their range with a probability of 2 in 32.
inline constexpr double kMedianConfidence = 0.9;

// Between two order statistics of the values, the closest to the middle that hold the median of the
// distribution with kMedianConfidence at least (the sign test, inverted: Conover, Practical
// Nonparametric Statistics, 1999, section 3.2). The whole range of fewer than five values, which
// are less than certain; 0 and 0 of none.
Interval medianInterval(std::vector<double> values);

}  // namespace whit::accuracy
