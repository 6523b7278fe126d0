#include "cli/effects_report.h"

#include <functional>
#include <nlohmann/json.hpp>

#include "accuracy/timing.h"
#include "core/index.h"
#include "core/text.h"
#include "output/json_report.h"

namespace whit::cli {

namespace {

// Adds to a row how much longer the frames of a run take than those of the run before in the same
// turn: the median, and the interval that it is known to lie in. A single turn has no interval.
template <typename Of>
void putAdded(Json& row, const std::string& key, const RunSummary& run, const RunSummary* before,
              const Of& of) {
  std::vector<double> added;
  for (const auto i : indices(run.frames)) {
    const double base = before ? std::invoke(of, before->frames.at(i)) : 0;
    added.push_back(std::invoke(of, run.frames[i]) - base);
  }

  constexpr double kConfidence = 0.95;
  const accuracy::Interval known = accuracy::medianInterval(added, kConfidence);
  const bool isKnown = added.size() > 1;
  row[key] = quantile(added, 0.5);
  row[key + "_low"] = isKnown ? Json(known.low) : Json(nullptr);
  row[key + "_high"] = isKnown ? Json(known.high) : Json(nullptr);
}

// True if the interval of an added time holds 0, or is unknown.
bool isNoise(const Json& row) {
  const Json &low = row["added_ms_low"], &high = row["added_ms_high"];
  return low.is_null() || (low.get<double>() <= 0 && high.get<double>() >= 0);
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
      "together come to %.2f ms; the last frame takes %.2f ms. The median lies in the interval\n"
      "with a probability of 95 %%; '~' marks noise: the interval holds 0, or is not known.\n",
      turns, sum, rows.back()["frame_ms"].get<double>());
}

}  // namespace

Json effectsRows(const std::vector<EffectStep>& steps) {
  Json rows = Json::array();
  for (const EffectStep& step : steps) {
    // The first step has none before it and counts in full.
    const EffectStep* const before = &step == steps.data() ? nullptr : &step - 1;
    const FrameStats frame = medianFrame(step.run);
    const RunSummary* const runBefore = before ? &before->run : nullptr;
    Json row{{"effect", step.added}, {"frame_ms", frame.frameMs}};
    putAdded(row, "added_ms", step.run, runBefore, &FrameStats::frameMs);
    putAdded(row, "added_outside_embree_ms", step.run, runBefore, outsideEmbreeMs);

    for (const auto k : indices(kRayKindCount))
      row[std::string(kRayKinds[k].name) + "_rays"] = frame.meter.tally[k].rays;

    row["added_rays"] = raysOf(step) - (before ? raysOf(*before) : 0);
    row["memory_mb"] = step.memoryMb;
    row["added_memory_mb"] = step.memoryMb - (before ? before->memoryMb : 0);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string effectsTable(const Json& effects) {
  std::string text =
      formatted("%-18s%10s%11s  %-18s%16s%12s%10s\n", "effect", "frame ms", "added ms",
                "95 % interval", "outside Embree", "added rays", "added MB");

  for (const Json& row : effects["effects"]) {
    const auto number = [&](const char* key) { return row[key].get<double>(); };
    const bool first = row == effects["effects"].front();
    const std::string label = (first ? "" : "+ ") + row["effect"].get<std::string>();
    const std::string interval =
        row["added_ms_low"].is_null()
            ? "unknown"
            : formatted("%+.2f to %+.2f", number("added_ms_low"), number("added_ms_high"));
    text += formatted("%-18s%10.2f %c%+9.2f  %-18s%+16.2f%+12.0f%+10.2f\n", label.c_str(),
                      number("frame_ms"), isNoise(row) ? '~' : ' ', number("added_ms"),
                      interval.c_str(), number("added_outside_embree_ms"), number("added_rays"),
                      number("added_memory_mb"));
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
