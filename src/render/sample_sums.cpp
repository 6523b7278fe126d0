#include "render/sample_sums.h"

#include <algorithm>
#include <cmath>

namespace whit {

double SampleSums::relativeError(int samples) const {
  const double n = samples;
  double errors = 0, radiance = 0;
  for (const SampleSum& sum : sums_) {
    const double mean = (sum.total.x + sum.total.y + sum.total.z) / (3 * n);
    errors += std::sqrt(std::max(sum.squares / n - mean * mean, 0.0) / (n - 1));
    radiance += mean;
  }
  return radiance > 0 ? errors / radiance : 0;
}

}  // namespace whit
