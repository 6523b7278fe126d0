#include "viewer/session/knob_costs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/option_table.h"
#include "core/text.h"

namespace whit::view {

namespace {

struct Candidate {
  std::string name, other;
  RenderOptions options;
};

std::vector<Candidate> candidatesOf(const Renderer& renderer, const RenderOptions& options) {
  // Each option is compared with its cheapest setting.
  std::vector<Candidate> candidates;
  forEachOption(options, [&](const OptionSpec& spec, const auto&) {
    if (spec.cheapest.empty()) return;
    Candidate candidate{std::string(spec.name), std::string(spec.cheapest), options};
    setOption(candidate.options, candidate.name, candidate.other);
    candidates.push_back(std::move(candidate));
  });

  // Each effect that is traced is compared with its absence.
  renderer.plan().effects.forEach([&](Effect effect) {
    Candidate candidate{std::string(nameOf(effect)), "off", options};
    candidate.options.disable = candidate.options.disable.with(effect);
    candidates.push_back(std::move(candidate));
  });

  // Settings that change nothing are left out, and those that need another acceleration
  // structure.
  std::erase_if(candidates, [&](const Candidate& c) {
    return c.options == options || !renderer.canSetOptions(c.options);
  });
  return candidates;
}

}  // namespace

std::vector<KnobCost> significantCosts(std::vector<KnobCost> costs) {
  std::erase_if(costs, [](const KnobCost& cost) { return !cost.significant(); });
  std::ranges::stable_sort(costs, [](const KnobCost& a, const KnobCost& b) {
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

bool measureKnobs(Renderer& renderer, const RenderOptions& options, const Camera& camera,
                  Film& film, double scale, const MeasureCall& goesOn) {
  // The first frame after a change fills new queues and does not count.
  const auto frameWith = [&](const RenderOptions& chosen) {
    renderer.setOptions(chosen);
    renderer.render(camera, film);
    return renderer.render(camera, film);
  };

  std::vector<KnobCost> costs;
  double measured = 0;
  const std::vector<Candidate> candidates = candidatesOf(renderer, options);
  FrameStats now = frameWith(options);

  for (const Candidate& candidate : candidates) {
    accuracy::TimeSamples samples;
    FrameStats then;
    for (int round = 0; round < accuracy::kConfidentRounds; ++round) {
      if (!goesOn(costs, measured)) return false;

      // Frames with both settings alternate, and each is compared with the mean of its two
      // neighbors: a slow change of the machine's speed cancels.
      const double before = now.frameMs;
      then = frameWith(candidate.options);
      now = frameWith(options);

      samples.ms.push_back(now.frameMs);
      samples.ratios.push_back(2 * then.frameMs / (before + now.frameMs));
    }

    const accuracy::Timing timing = samples.timing();
    costs.push_back({candidate.name, candidate.other, now, then, timing, scale * timing.medianMs});
    measured = static_cast<double>(costs.size()) / static_cast<double>(candidates.size());
  }
  return goesOn(costs, measured);
}

}  // namespace whit::view
