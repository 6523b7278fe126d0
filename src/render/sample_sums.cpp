#include "render/sample_sums.h"

#include <algorithm>
#include <cmath>

namespace whit {

double SampleSum::standardError(int samples) const {
  if (samples < 2) return kInfinity;
  const double n = samples, squaresOfMean = dot(total, total) / (3 * n * n);
  return std::sqrt(std::max(squares / n - squaresOfMean, 0.0) / (n - 1));
}

double SampleSums::relativeError(int samples) const {
  double errors = 0, radiance = 0;
  for (const SampleSum& sum : sums_) {
    errors += sum.standardError(samples);
    radiance += (sum.total.x + sum.total.y + sum.total.z) / (3.0 * samples);
  }
  return radiance > 0 ? errors / radiance : 0;
}

}  // namespace whit
