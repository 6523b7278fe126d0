#include "accuracy/timing.h"

#include <algorithm>
#include <cmath>

#include "core/quantile.h"
#include "core/stopwatch.h"

namespace whit::accuracy {

namespace {

// The number of values that can be left out at either end. The median of the distribution lies
// beyond the remaining values with P(Binomial(n, 1/2) <= leftOut) at either end, and half of the
// error that the confidence allows is available for each.
std::size_t valuesLeftOut(std::size_t n, double confidence) {
  // Logarithms, because 2^-n underflows for the thousands of frames of a baseline.
  double logTerm = -static_cast<double>(n) * std::log(2.0), below = 0;  // P(X = k), P(X < k)
  std::size_t k = 0;

  while (below + std::exp(logTerm) <= (1 - confidence) / 2) {
    below += std::exp(logTerm);
    // The recurrence of the binomial coefficients leads from P(X = k) to P(X = k + 1).
    logTerm += std::log(static_cast<double>(n - k) / static_cast<double>(k + 1));
    ++k;
  }
  return k == 0 ? 0 : k - 1;
}

}  // namespace

Interval medianInterval(std::vector<double> values, double confidence) {
  if (values.empty()) return {};
  std::ranges::sort(values);
  const std::size_t leftOut = valuesLeftOut(values.size(), confidence);
  return {values[leftOut], values[values.size() - 1 - leftOut]};
}

Timing TimeSamples::timing() const {
  Timing timing;
  timing.frames = static_cast<int>(ms.size());
  timing.medianMs = timing.steadyMs = quantile(ms, 0.5);
  timing.leastMs = quantile(ms, 1e-9);
  timing.rounds = provisional ? 0 : static_cast<int>(ratios.size());
  timing.ratio = quantile(ratios, 0.5);

  const Interval interval = medianInterval(ratios);
  timing.ratioLow = interval.low;
  timing.ratioHigh = interval.high;
  return timing;
}

// Times the second of two frames. The first one fills the caches with the data of this renderer.
double PointTimer::secondFrameMs(FrameSource& source) {
  source.render();
  const double ms = source.render().frameMs;
  if (&source == &baseline_) baselineMs_.push_back(ms);
  return ms;
}

void PointTimer::time(Point& point, FrameSource& frames, std::size_t points) {
  const Stopwatch stopwatch;
  const double shareMs = (budgetMs_ - spentMs_) / static_cast<double>(points);
  const double first = frames.stats.frameMs, baselineMs = baselineMs_.back();
  const double roundMs = 2 * (first + baselineMs);
  TimeSamples samples;

  // The first round has frames of the baseline before it.
  if (roundMs + 2 * baselineMs <= shareMs) {
    double after = secondFrameMs(baseline_);

    do {
      const double before = after;
      samples.ms.push_back(secondFrameMs(frames));
      after = secondFrameMs(baseline_);
      // The mean of the baseline's times before and after cancels a steady drift of the machine.
      samples.ratios.push_back(2 * samples.ms.back() / (before + after));
      point.timing = samples.timing();
    } while (point.timing.noisy() && point.timing.rounds < kMostRounds &&
             stopwatch.ms() + roundMs <= shareMs);
  } else {
    // No round fits into the share, so the first frame alone gives the time.
    samples = {{first}, {first / baselineMs}, true};
    point.timing = samples.timing();
  }

  spentMs_ += stopwatch.ms();
}

Timing PointTimer::baselineTiming() const {
  TimeSamples samples{baselineMs_, {}, false};
  const double median = quantile(baselineMs_, 0.5);
  for (const double ms : baselineMs_) samples.ratios.push_back(ms / median);
  return samples.timing();
}

}  // namespace whit::accuracy
