#include "viewer/knob_measurement.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/formatted.h"
#include "core/option_table.h"

namespace whit::view {

namespace {

constexpr int kTurns = 5;  // all of one above all of the other: by chance once in 126

struct Candidate {
  std::string name, other;
  RenderOptions options;
};

std::vector<Candidate> candidatesOf(const Renderer& renderer, const RenderOptions& options) {
  std::vector<Candidate> candidates;
  forEachOption(options, [&](const OptionSpec& spec, const auto&) {
    if (spec.cheapest.empty()) return;
    Candidate candidate{std::string(spec.name), std::string(spec.cheapest), options};
    setOption(candidate.options, candidate.name, candidate.other);
    candidates.push_back(std::move(candidate));
  });
  for (int i = 0; i < kEffectCount; ++i) {
    const auto effect = static_cast<Effect>(i);
    if (!renderer.plan().effects.has(effect)) continue;
    Candidate candidate{std::string(kEffectNames[static_cast<std::size_t>(i)].name), "off",
                        options};
    candidate.options.disable = candidate.options.disable.with(effect);
    candidates.push_back(std::move(candidate));
  }
  std::erase_if(candidates, [&](const Candidate& c) {
    return c.options == options || !renderer.canSetOptions(c.options);
  });
  return candidates;
}

// Frames of the same settings. The first after a change fills new queues and does not count.
class Turns {
 public:
  void take(Renderer& renderer, const RenderOptions& options, const Camera& camera, Film& film) {
    renderer.setOptions(options);
    renderer.render(camera, film);
    const FrameStats stats = renderer.render(camera, film);
    longestMs_ = std::max(longestMs_, stats.frameMs);
    if (quickest.frameMs == 0 || stats.frameMs < quickest.frameMs) quickest = stats;
  }
  double spreadMs() const { return longestMs_ - quickest.frameMs; }

  FrameStats quickest;

 private:
  double longestMs_ = 0;
};

// As of a frame that is so many times as large.
FrameStats scaled(FrameStats stats, double scale) {
  stats.frameMs *= scale;
  for (RayTally& tally : stats.meter.tally) {
    tally.rays = static_cast<std::uint64_t>(std::llround(static_cast<double>(tally.rays) * scale));
  }
  return stats;
}

}  // namespace

std::vector<KnobCost> toldFromNoise(std::vector<KnobCost> costs) {
  std::erase_if(costs, [](const KnobCost& cost) { return !cost.significant(); });
  std::stable_sort(costs.begin(), costs.end(), [](const KnobCost& a, const KnobCost& b) {
    return std::abs(a.ms()) > std::abs(b.ms());
  });
  return costs;
}

std::string costText(const KnobCost& cost) {
  const double ms = std::abs(cost.ms());
  return formatted("%s would be %.*f ms %s", cost.other.c_str(), ms < 10 ? 1 : 0, ms,
                   cost.ms() > 0 ? "faster" : "slower");
}

ImageSize measuredSize(const ImageSize& window, double msPerPixel) {
  const double ms = msPerPixel * window.width * window.height;
  const double side = ms > kMeasuredMs ? std::sqrt(kMeasuredMs / ms) : 1;
  const auto scaled = [&](int pixels) {
    return std::max(static_cast<int>(std::lround(pixels * side)), 1);
  };
  return {scaled(window.width), scaled(window.height)};
}

std::vector<KnobCost> measureKnobs(Renderer& renderer, const RenderOptions& options,
                                   const Camera& camera, Film& film, double scale,
                                   const MeasureCalls& calls) {
  std::vector<KnobCost> costs;
  const std::vector<Candidate> candidates = candidatesOf(renderer, options);
  for (const Candidate& candidate : candidates) {
    Turns now, then;
    for (int turn = 0; turn < kTurns; ++turn) {
      if (calls.superseded()) return {};
      then.take(renderer, candidate.options, camera, film);
      if (calls.superseded()) {
        renderer.setOptions(options);
        return {};
      }
      now.take(renderer, options, camera, film);
    }
    costs.push_back({candidate.name, candidate.other, scaled(now.quickest, scale),
                     scaled(then.quickest, scale),
                     scale * std::max(now.spreadMs(), then.spreadMs())});
    calls.show(costs, candidates.size());
  }
  return costs;
}

}  // namespace whit::view
