#include "cli/effects_report.h"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "core/text.h"
#include "output/json_report.h"

namespace whit::cli {

namespace {

// Returns the median over the turns of how much `of` differs between the frames of two runs.
template <typename Of>
double medianAdded(const RunSummary& run, const RunSummary& before, const Of& of) {
  std::vector<double> added;
  for (std::size_t i = 0; i < std::min(run.frames.size(), before.frames.size()); ++i) {
    added.push_back(std::invoke(of, run.frames[i]) - std::invoke(of, before.frames[i]));
  }
  return quantile(added, 0.5);
}

std::int64_t raysOf(const EffectStep& step) {
  return static_cast<std::int64_t>(medianFrame(step.run).allRays());
}

// Why the times do not add up, and by how much.
std::string noteOn(const Json& rows, std::size_t turns) {
  double sum = 0;
  for (const Json& row : rows) sum += row["added_ms"].get<double>();
  return formatted(
      "Rays and MB add up. Times do not: an added time is the median, over %zu turns, of the\n"
      "difference from the row above, in which disturbances of both frames cancel. All rows\n"
      "together come to %.2f ms; the last frame takes %.2f ms.\n",
      turns, sum, rows.back()["frame_ms"].get<double>());
}

}  // namespace

Json effectsRows(const std::vector<EffectStep>& steps) {
  Json rows = Json::array();
  for (const EffectStep& step : steps) {
    // The first step has none before it and counts in full.
    const EffectStep* const before = &step == steps.data() ? nullptr : &step - 1;
    const FrameStats frame = medianFrame(step.run);
    Json row{
        {"effect", step.added},
        {"frame_ms", frame.frameMs},
        {"added_ms",
         before ? medianAdded(step.run, before->run, &FrameStats::frameMs) : frame.frameMs},
        {"added_outside_embree_ms",
         before ? medianAdded(step.run, before->run, outsideEmbreeMs) : outsideEmbreeMs(frame)}};

    for (std::size_t k = 0; k < kRayKindCount; ++k)
      row[std::string(kRayKinds[k].name) + "_rays"] = frame.meter.tally[k].rays;

    row["added_rays"] = raysOf(step) - (before ? raysOf(*before) : 0);
    row["memory_mb"] = step.memoryMb;
    row["added_memory_mb"] = step.memoryMb - (before ? before->memoryMb : 0);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string effectsTable(const Json& effects) {
  std::string text = formatted("%-18s%10s%10s%16s%12s%10s\n", "effect", "frame ms", "added ms",
                               "outside Embree", "added rays", "added MB");

  for (const Json& row : effects["effects"]) {
    const auto number = [&](const char* key) { return row[key].get<double>(); };
    const bool first = row == effects["effects"].front();
    const std::string label = (first ? "" : "+ ") + row["effect"].get<std::string>();
    text += formatted("%-18s%10.2f%+10.2f%+16.2f%+12.0f%+10.2f\n", label.c_str(),
                      number("frame_ms"), number("added_ms"), number("added_outside_embree_ms"),
                      number("added_rays"), number("added_memory_mb"));
  }

  return text + "\n" + effects["note"].get<std::string>();
}

Json effectsJson(const std::vector<EffectStep>& steps, const std::vector<std::string>& pictures) {
  const RunSummary& run = steps.at(0).run;
  const Json rows = effectsRows(steps);
  return {{"report", "effects"},
          {"scene", run.scene},
          {"width", run.width},
          {"height", run.height},
          {"threads", run.machine.threads},
          {"simd", run.machine.simd},
          {"packet", run.machine.packet},
          {"turns", run.frames.size()},
          {"note", noteOn(rows, run.frames.size())},
          {"effects", rows},
          {"pictures", pictures}};
}

}  // namespace whit::cli
