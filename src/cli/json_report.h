// Results as JSON, for other programs. The keys are a contract: adding is fine, renaming is not.
// Units are in the names; megabytes are 10^6 bytes.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/measurement.h"
#include "cli/app/frame_summary.h"
#include "core/warnings.h"
#include "inspect/metrics.h"
#include "inspect/stage_comparison.h"

namespace whit::cli {

using Json = nlohmann::ordered_json;

// The machine and the build; seed and extent of a sweep are not set.
accuracy::RunFacts machineFacts();
Json machineJson(const Machine& machine);
// `writing_ms`, where images were written, has the medians of what writing one took and of what the
// tracing waited for it; `written_per_s` is the rate of both together. `stages_ms`, `embree_ms`,
// `rays` and what follows are those of the median frame; a run of no frames, whose images were all
// there, has none of what is measured on frames.
Json runJson(const RunSummary& run);
// For runs that come in pairs adds the ratio of the second over the first: `all_over_auto` for
// effects, `warm_over_off` for the shadow cache.
Json benchJson(const std::vector<RunSummary>& runs, RunPairs pairs = RunPairs::none);

// The comparison of a channel that both pictures have.
struct ChannelDifference {
  std::string name;  // "depth.Z"
  bool countsThings = false;
  ValueDifference difference;
};

struct Comparison {
  ImageDifference difference;
  std::optional<double> pathDivergencesPerMpx;         // unknown of two files
  std::optional<double> timeMsA, timeMsB;              // unknown of two files
  std::optional<std::vector<StageDifference>> stages;  // with --stages
  std::vector<ChannelDifference> channels;
};
// Infinite and unknown numbers are null.
Json compareJson(const Comparison& comparison);

Json infoJson(const Scene& scene, const Renderer& renderer, const RenderOptions& options,
              const Warnings& warnings);

// Every kernel: {"targets":[...],"kernels":[{stage, kernel}]}.
Json kernelsJson();

// "-" is standard output. Throws Error(io).
void writeJson(const std::string& path, const Json& json);

}  // namespace whit::cli
