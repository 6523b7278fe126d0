#include "cli/effects_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "accuracy/csv.h"
#include "cli/json_report.h"
#include "core/formatted.h"

namespace whit::cli {

namespace {

double outside(const FrameStats& frame) { return frame.frameMs - frame.embreeMs(); }

// The median over the turns of the difference that `of` has between the frames of two runs.
template <typename Of>
double medianAdded(const RunSummary& run, const RunSummary& before, const Of& of) {
  std::vector<double> added;
  for (std::size_t i = 0; i < std::min(run.frames.size(), before.frames.size()); ++i) {
    added.push_back(of(run.frames[i]) - of(before.frames[i]));
  }
  return quantile(added, 0.5);
}

double raysOf(const EffectStep& step) {
  return static_cast<double>(medianFrame(step.run).allRays());
}

std::string label(const EffectStep& step, std::size_t index) {
  return index == 0 ? step.added : "+ " + step.added;
}

}  // namespace

std::vector<EffectCost> effectCosts(const std::vector<EffectStep>& steps) {
  std::vector<EffectCost> costs;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const EffectStep& step = steps[i];
    EffectCost cost;
    cost.frameMs = medianFrame(step.run).frameMs;
    if (i == 0) {
      cost.addedMs = cost.frameMs;
      cost.outsideMs = outsideEmbreeMs(step.run);
      cost.addedRays = raysOf(step);
      cost.addedMb = step.memoryMb;
    } else {
      const EffectStep& before = steps[i - 1];
      cost.addedMs =
          medianAdded(step.run, before.run, [](const FrameStats& f) { return f.frameMs; });
      cost.outsideMs = medianAdded(step.run, before.run, outside);
      cost.addedRays = raysOf(step) - raysOf(before);
      cost.addedMb = step.memoryMb - before.memoryMb;
    }
    costs.push_back(cost);
  }
  return costs;
}

std::string effectsTable(const std::vector<EffectStep>& steps) {
  const std::vector<EffectCost> costs = effectCosts(steps);
  std::string text = formatted("%-18s%10s%10s%16s%12s%10s\n", "effect", "frame ms", "added ms",
                               "outside Embree", "added rays", "added MB");
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const EffectCost& c = costs[i];
    text += formatted("%-18s%10.2f%+10.2f%+16.2f%+12.0f%+10.2f\n", label(steps[i], i).c_str(),
                      c.frameMs, c.addedMs, c.outsideMs, c.addedRays, c.addedMb);
  }
  return text + "\n" + effectsNote(steps);
}

std::string effectsNote(const std::vector<EffectStep>& steps) {
  const std::vector<EffectCost> costs = effectCosts(steps);
  double sum = 0;
  for (const EffectCost& c : costs) sum += c.addedMs;
  return formatted(
      "Rays and MB add up. Times do not: an added time is the median, over %zu turns, of the\n"
      "difference from the row above, in which disturbances of both frames cancel. All rows\n"
      "together come to %.2f ms; the last frame takes %.2f ms.\n",
      steps.at(0).run.frames.size(), sum, costs.back().frameMs);
}

Json effectsRows(const std::vector<EffectStep>& steps) {
  const std::vector<EffectCost> costs = effectCosts(steps);
  Json rows = Json::array();
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const EffectCost& c = costs[i];
    Json row{{"effect", steps[i].added},
             {"frame_ms", c.frameMs},
             {"added_ms", c.addedMs},
             {"added_outside_embree_ms", c.outsideMs}};
    const FrameStats frame = medianFrame(steps[i].run);
    for (std::size_t k = 0; k < kRayKindCount; ++k)
      row[std::string(kRayKinds[k].name) + "_rays"] = frame.meter.tally[k].rays;
    row["added_rays"] = static_cast<std::int64_t>(c.addedRays);
    row["memory_mb"] = steps[i].memoryMb;
    row["added_memory_mb"] = c.addedMb;
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string effectsCsv(const std::vector<EffectStep>& steps) {
  return accuracy::csvOf(effectsRows(steps));
}

Json effectsJson(const std::vector<EffectStep>& steps, const std::vector<std::string>& pictures) {
  const RunSummary& run = steps.at(0).run;
  return {{"report", "effects"},
          {"scene", run.scene},
          {"width", run.width},
          {"height", run.height},
          {"threads", run.machine.threads},
          {"simd", run.machine.simd},
          {"packet", run.machine.packet},
          {"turns", run.frames.size()},
          {"note", effectsNote(steps)},
          {"effects", effectsRows(steps)},
          {"pictures", pictures}};
}

}  // namespace whit::cli
