#include "viewer/knob_measurement.h"

#include <algorithm>
#include <utility>

#include "core/option_table.h"

namespace whit::view {

namespace {

constexpr int kTurns = 3;

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

}  // namespace

std::vector<KnobCost> measureKnobs(Renderer& renderer, const RenderOptions& options,
                                   const Camera& camera, Film& film,
                                   const std::function<bool()>& superseded) {
  std::vector<KnobCost> costs;
  for (const Candidate& candidate : candidatesOf(renderer, options)) {
    Turns now, then;
    for (int turn = 0; turn < kTurns; ++turn) {
      if (superseded()) return {};
      then.take(renderer, candidate.options, camera, film);
      if (superseded()) {
        renderer.setOptions(options);
        return {};
      }
      now.take(renderer, options, camera, film);
    }
    costs.push_back({candidate.name, candidate.other, now.quickest, then.quickest,
                     std::max(now.spreadMs(), then.spreadMs())});
  }
  return costs;
}

}  // namespace whit::view
