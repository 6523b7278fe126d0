#include "accuracy/timing.h"

#include <algorithm>
#include <cmath>

#include "core/quantile.h"
#include "core/stopwatch.h"

namespace whit::accuracy {

namespace {

// The part of a point's share of the budget that time() uses. All points get an error before any
// gets a good time; repeat() uses the rest.
constexpr double kFirstShare = 0.25;

// The number of values that can be left out at either end. The median of the distribution lies
// beyond the remaining values with P(Binomial(n, 1/2) <= spare) at either end, and half of the
// error that the confidence allows is available for each.
std::size_t spareValues(std::size_t n) {
  // Logarithms, because 2^-n underflows for the thousands of frames of a baseline.
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

double roundMs(const Block& block, double pointMs, double baselineMs) {
  return (block.frames + block.warmUp) * (pointMs + baselineMs);
}

Block blockFor(double pointMs, double baselineMs, double budgetMs) {
  for (const Block& block : {Block{4, 1}, Block{2, 1}}) {
    if (kConfidentRounds * roundMs(block, pointMs, baselineMs) <= budgetMs) return block;
  }
  return {1, 0};
}

Timing TimeSamples::timing() const {
  Timing timing;
  timing.frames = static_cast<int>(ms.size());
  timing.medianMs = timing.settledMs = quantile(ms, 0.5);
  timing.leastMs = quantile(ms, 1e-9);
  timing.rounds = provisional ? 0 : static_cast<int>(ratios.size());
  timing.ratio = quantile(ratios, 0.5);
  const Interval interval = medianInterval(ratios);
  timing.ratioLow = interval.low, timing.ratioHigh = interval.high;
  return timing;
}

std::vector<double> PointTimer::timeBlock(FrameSource& source, const Block& block) {
  for (int i = 0; i < block.warmUp; ++i) source.render();
  std::vector<double> ms(static_cast<std::size_t>(block.frames));
  for (double& frame : ms) frame = source.render().frameMs;
  if (&source == &baseline_) baselineMs_.insert(baselineMs_.end(), ms.begin(), ms.end());
  return ms;
}

void PointTimer::measureRounds(Point& point, FrameSource& frames, int mostRounds, double budgetMs) {
  const Stopwatch stopwatch;
  TimeSamples& samples = samples_[point.label()];
  const double pointMs = frames.stats.frameMs;
  const double baselineMs = baselineMs_.empty() ? pointMs : baselineMs_.back();
  const Block block = blockFor(pointMs, baselineMs, budgetMs);
  const double cost = roundMs(block, pointMs, baselineMs);
  // The first round has a block of the baseline before it.
  double left = budgetMs - roundMs(block, 0, baselineMs);
  if (left < cost) return;
  if (samples.provisional) samples = {};
  double after = quantile(timeBlock(baseline_, block), 0.5);
  while (left >= cost && samples.timing().rounds < mostRounds && samples.timing().noisy()) {
    const double before = after;
    const std::vector<double> ms = timeBlock(frames, block);
    after = quantile(timeBlock(baseline_, block), 0.5);
    samples.ms.insert(samples.ms.end(), ms.begin(), ms.end());
    // The ratio is to the mean of the baseline's blocks before and after.
    if (before + after > 0) samples.ratios.push_back(quantile(ms, 0.5) / ((before + after) / 2));
    left = budgetMs - stopwatch.ms();
  }
}

void PointTimer::time(Point& point, FrameSource& frames, std::size_t points) {
  const double share = kFirstShare * std::max(leftMs_, 0.0) / static_cast<double>(points);
  const Stopwatch stopwatch;
  TimeSamples& samples = samples_[point.label()];
  const double first = frames.stats.frameMs;
  measureRounds(point, frames, kMostRounds, share);
  if (samples.ratios.empty()) {
    if (firstFrames_++ % usesOfBaseline_ == 0) baselineMs_.push_back(baseline_.render().frameMs);
    samples = {{first}, {first / baselineMs_.back()}, true};
  }
  point.timing = samples.timing();
  leftMs_ -= stopwatch.ms();
}

void PointTimer::repeat(Point& point, int rounds, const Open& open) {
  const Stopwatch stopwatch;
  const std::unique_ptr<FrameSource> frames = open();
  frames->render();
  measureRounds(point, *frames, std::min(rounds, kMostRounds), leftMs_ - stopwatch.ms());
  point.timing = samples_[point.label()].timing();
  leftMs_ -= stopwatch.ms();
}

Timing PointTimer::baselineTiming() {
  if (baselineMs_.empty()) baselineMs_.push_back(baseline_.render().frameMs);
  TimeSamples samples{baselineMs_, {}, false};
  const double median = quantile(baselineMs_, 0.5);
  for (const double ms : baselineMs_) samples.ratios.push_back(ms / median);
  return samples.timing();
}

}  // namespace whit::accuracy
