#include "accuracy/timing.h"

#include "core/quantile.h"

namespace whit::accuracy {

namespace {

// Points of a single frame that one frame of the baseline serves; and where that is long as well.
constexpr int kUsesOfBaseline = 2, kUsesOfLongBaseline = 8;

std::vector<double> timeBlock(FrameSource& source, const Rounds& rounds) {
  for (int i = 0; i < rounds.warmUp; ++i) source.render();
  std::vector<double> ms(static_cast<std::size_t>(rounds.frames));
  for (double& frame : ms) frame = source.render().frameMs;
  return ms;
}

void append(std::vector<double>& all, const std::vector<double>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

FrameSource::FrameSource(const Scene& scene, const Camera& camera, const RenderOptions& options)
    : renderer(scene, options),
      film(makeFilm(scene, options)),
      camera_(camera),
      mode_(options.mode) {}

const FrameStats& FrameSource::render() {
  stats = mode_ == Mode::reference ? renderer.renderReference(camera_, film)
                                   : renderer.render(camera_, film);
  return stats;
}

Rounds roundsFor(double pointMs, double baselineMs, double budgetMs) {
  const auto cost = [&](const Rounds& r) {
    return (r.frames + r.warmUp) * (r.count * pointMs + (r.count + 1) * baselineMs);
  };
  for (const Rounds& rounds : {Rounds{3, 4, 1}, Rounds{3, 2, 1}, Rounds{3, 1, 0}}) {
    if (cost(rounds) <= budgetMs) return rounds;
  }
  return {1, 1, 0};
}

Timing timingOf(const std::vector<double>& ms) {
  Timing timing;
  timing.frames = static_cast<int>(ms.size());
  timing.medianMs = timing.settledMs = quantile(ms, 0.5);
  timing.leastMs = quantile(ms, 1e-9);
  if (timing.medianMs > 0) {
    timing.iqrPct = 100 * (quantile(ms, 0.75) - quantile(ms, 0.25)) / timing.medianMs;
  }
  return timing;
}

Timing timePoint(FrameSource& point, FrameSource& baseline, const Rounds& rounds,
                 std::vector<double>& baselineMs) {
  std::vector<double> before = timeBlock(baseline, rounds), all, ratios;
  append(baselineMs, before);
  for (int round = 0; round < rounds.count; ++round) {
    const std::vector<double> ms = timeBlock(point, rounds);
    const std::vector<double> after = timeBlock(baseline, rounds);
    append(all, ms);
    append(baselineMs, after);
    const double around = (quantile(before, 0.5) + quantile(after, 0.5)) / 2;
    if (around > 0) ratios.push_back(quantile(ms, 0.5) / around);
    before = after;
  }
  Timing timing = timingOf(all);
  timing.ratio = quantile(ratios, 0.5);
  return timing;
}

// Combinations are many: they are timed as in a quick sweep.
void PointTimer::time(Point& point, FrameSource& frames) {
  const double first = frames.stats.frameMs;
  if (point.options.mode == Mode::reference || first > scope_.limits.pointMs) {
    takeSingleFrame(point, first);
    return;
  }
  const bool joint = point.kind == PointKind::joint;
  const double baselineMs = baselineMs_.empty() ? first : baselineMs_.back();
  const Rounds rounds =
      roundsFor(first, baselineMs, joint ? kQuick.pointMs : scope_.limits.pointMs);
  if (rounds.count == 1) {
    takeSingleFrame(point, frames.render().frameMs);
  } else {
    point.timing = timePoint(frames, baseline_, rounds, baselineMs_);
  }
}

// Beside one of the baseline, of which every other point has a new one.
void PointTimer::takeSingleFrame(Point& point, double ms) {
  const int uses = scope_.longFrames() ? kUsesOfLongBaseline : kUsesOfBaseline;
  if (singleFrames_++ % uses == 0) {
    baselineMs_.push_back(baseline_.render().frameMs);
  }
  point.timing = timingOf({ms});
  point.timing.ratio = ms / baselineMs_.back();
}

const std::vector<double>& PointTimer::baselineMs() {
  if (baselineMs_.empty()) baselineMs_.push_back(baseline_.render().frameMs);
  return baselineMs_;
}

}  // namespace whit::accuracy
