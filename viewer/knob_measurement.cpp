#include "viewer/knob_measurement.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/option_values.h"

namespace whit::view {

namespace {

constexpr int kTurns = 3;

// The cheapest setting that still makes a picture of the scene.
constexpr std::array<std::pair<const char*, const char*>, 13> kCheapest{
    {{"depth", "0"},
     {"cutoff", "0.004"},
     {"light-cutoff", "0.004"},
     {"glossy", "0"},
     {"fresnel", "schlick"},
     {"texture-filter", "nearest"},
     {"offset", "fixed"},
     {"terminator", "off"},
     {"bend", "off"},
     {"reciprocal", "approximate"},
     {"film", "float"},
     {"srgb", "table"},
     {"effects", "auto"}}};

struct Candidate {
  std::string name, other;
  RenderOptions options;
};

std::vector<Candidate> candidatesOf(const Renderer& renderer, const RenderOptions& options) {
  std::vector<Candidate> candidates;
  for (const auto& [name, cheapest] : kCheapest) {
    Candidate candidate{name, cheapest, options};
    forEachOption(candidate.options, [&](const std::string& option, const char* placeholder,
                                         const char*, auto& field) {
      if (option != candidate.name) return;
      parseValue(renderOptionSpec(option, placeholder), candidate.other, field);
    });
    candidates.push_back(std::move(candidate));
  }
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
