// whit bench: how long a frame takes, by stage and by kind of ray.
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/app/image_output.h"
#include "cli/app/progress_bar.h"
#include "cli/bench_run.h"
#include "cli/commands.h"
#include "cli/json_report.h"
#include "core/error.h"
#include "render/shadow_cache_schedule.h"

namespace whit::cli {

namespace {

constexpr const char* kBenchUsage = "whit bench SCENE... [options]";
constexpr const char* kBenchSummary =
    "Measures the time of frames by stage and by kind of ray. The frames of the runs of --widths "
    "and "
    "of the --ab options take turns, so that other load of the machine affects all of them alike.";
constexpr int kWidths[] = {1, 4, 8, 16};

struct BenchJob {
  CommonOptions common;
  std::vector<std::string> scenes;
  int frames = 0;  // 0: not given
  bool floor = false, widths = false, abEffects = false, abShadowCache = false;
  std::string json;

  bool reference() const { return common.render.mode == Mode::reference; }
  // The reference takes seconds a frame, against which warming up is nothing.
  Turns turns() const {
    Turns turns;
    if (reference()) turns = {0, 1};
    // After the frame that fills queues, those with an empty shadow cache.
    if (abShadowCache) turns.warmUp = 1 + ShadowCacheSchedule::kTurns;
    if (frames > 0) turns.counted = frames;
    turns.floor = floor;
    return turns;
  }
  bool comparesRuns() const { return widths || abEffects || abShadowCache; }
  RunPairs pairs() const {
    if (abShadowCache) return RunPairs::shadowCache;
    return abEffects ? RunPairs::effects : RunPairs::none;
  }
};

OptionList listOptions(BenchJob& job) {
  OptionList list;
  list.group("Measuring");
  list.value({"frames", "N", 1, 1e6}, "measured frames (20 after 3 to warm up; reference: 1)",
             job.frames);
  list.flag("floor", "also measure Embree alone on the same rays", job.floor);
  list.flag("widths", "packets of 1, 4, 8 and 16 as separate runs", job.widths);
  list.flag("ab-effects", "kernels with the scene's effects and with every effect as two runs",
            job.abEffects);
  list.flag("ab-shadow-cache", "without and with the shadow cache as two runs", job.abShadowCache);
  list.value({"json", "FILE"}, "all runs as JSON; - is standard output", job.json);
  listCommonOptions(list, job.common);
  list.operands("SCENE...", "scene files, models, or names of shipped scenes", 1,
                std::numeric_limits<std::size_t>::max(), job.scenes);
  return list;
}

void addRuns(BenchRuns& runs, const std::string& name, const BenchJob& job, Progress* progress) {
  const std::shared_ptr<const OpenScene> open = openScene(name, job.common, progress);
  const auto add = [&](const RenderOptions& options) {
    runs.push_back(std::make_unique<BenchRun>(open, job.common, options, progress));
  };
  RenderOptions options = optionsFor(open->scene, job.common);
  if (job.widths) {
    for (const int width : kWidths) {
      options.packet = width;
      add(options);
    }
  } else if (job.abEffects) {
    for (const EffectChoice choice : {EffectChoice::automatic, EffectChoice::all}) {
      options.effects = choice;
      add(options);
    }
  } else if (job.abShadowCache) {
    for (const ShadowCacheMode shadowCache :
         {ShadowCacheMode::off, job.common.render.shadowCache}) {
      options.shadowCache = shadowCache;
      add(options);
    }
    runs.back()->useShadowCache();
  } else {
    add(options);
    if (options.shadowCache == ShadowCacheMode::audit) runs.back()->useShadowCache();
  }
}

void checkJob(const BenchJob& job) {
  requireJsonWritable(job.json);
  const auto refuseIf = [](bool wrong, const char* why) {
    if (wrong) throwUsage(why);
  };
  const std::set<std::string>& given = job.common.given;
  const bool reference = job.reference();
  refuseIf(reference && job.floor, "--floor is for packets, not --mode reference");
  refuseIf(reference && job.widths, "--widths is for packets, not --mode reference");
  refuseIf(reference && job.abEffects, "--ab-effects is for packets, not --mode reference");
  refuseIf(reference && job.abShadowCache,
           "--ab-shadow-cache is for packets, not --mode reference");
  refuseIf(job.widths + job.abEffects + job.abShadowCache > 1,
           "--ab-shadow-cache, --ab-effects and --widths are runs of their own: give one of them");
  refuseIf(job.widths && given.contains("packet"),
           "--widths runs every packet width: leave out --packet");
  refuseIf(job.abEffects && given.contains("effects"),
           "--ab-effects runs both choices of --effects: leave out --effects");
  refuseIf(job.abShadowCache && job.common.render.shadowCache == ShadowCacheMode::off,
           "--ab-shadow-cache runs without the cache as well: leave out --shadow-cache off");
}

// For runs that come in pairs the ratio of the second over the first is added.
Json benchJson(const std::vector<RunSummary>& runs, RunPairs pairs) {
  Json json{{"schema", 1}, {"machine", machineJson(runs.at(0).machine)}};
  json["runs"] = Json::array();
  for (const RunSummary& run : runs) json["runs"].push_back(runJson(run));
  const char* const name = pairs == RunPairs::shadowCache ? "warm_over_off" : "all_over_auto";
  for (std::size_t i = 0; pairs != RunPairs::none && i + 1 < runs.size(); i += 2) {
    const RunRatio ratio = ratioOf(runs[i + 1], runs[i]);
    json[name].push_back({{"scene", runs[i].scene},
                          {"frame", ratio.frame},
                          {"outside_embree", ratio.outsideEmbree}});
  }
  return json;
}

}  // namespace

int benchCommand(const Words& words) {
  BenchJob job;
  if (parseOptions(kBenchUsage, kBenchSummary, listOptions(job), words) == Parsed::helpShown)
    return 0;
  settleOptions(job.common);
  checkJob(job);
  auto progress = makeProgressBar(job.common);
  std::vector<RunSummary> summaries;
  BenchRuns runs;
  for (std::size_t i = 0; i < job.scenes.size(); ++i) {
    addRuns(runs, job.scenes[i], job, progress.get());
    // Runs to be compared are held in memory together; others one after the other.
    if (job.comparesRuns() && i + 1 < job.scenes.size()) continue;
    takeTurns(runs, job.turns(), progress.get());
    for (const auto& run : runs) summaries.push_back(run->summary());
    runs.clear();
  }
  progress.reset();
  FILE* const people = job.json == "-" ? stderr : stdout;
  if (people == stdout || !job.common.quiet) {
    for (const RunSummary& run : summaries) std::fprintf(people, "%s\n", stageTable(run).c_str());
    for (std::size_t i = 0; job.pairs() != RunPairs::none && i + 1 < summaries.size(); i += 2) {
      std::fprintf(people, "%s", ratioText(job.pairs(), summaries[i], summaries[i + 1]).c_str());
    }
  }
  if (!job.json.empty()) writeJson(job.json, benchJson(summaries, job.pairs()));
  return 0;
}

}  // namespace whit::cli
