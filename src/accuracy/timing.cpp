#include "accuracy/timing.h"

#include "core/quantile.h"

namespace whit::accuracy {

namespace {

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

Rounds roundsFor(double pointMs, double baselineMs, double budgetMs, bool thorough) {
  if (pointMs > budgetMs) return {1, 1, 0};
  if (thorough) return {3, 4, 1};
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

}  // namespace whit::accuracy
