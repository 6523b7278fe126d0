// whit bench: how long a frame takes, by stage and by kind of ray.
#include <algorithm>
#include <array>
#include <cstdio>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "cli/app/image_output.h"
#include "cli/app/open_scene.h"
#include "cli/bench_run.h"
#include "cli/commands.h"
#include "core/error.h"
#include "core/option_table.h"

namespace whit::cli {

namespace {

constexpr const char* kBenchUsage = "whit bench SCENE... [options]";
constexpr const char* kBenchSummary =
    "Measures the time of frames by stage and by kind of ray. The frames of the runs of --widths "
    "and "
    "of the --ab options take turns, so that other load of the machine affects all of them alike.";

// An option whose values are measured as separate runs, which take turns.
struct Series {
  const char *flag, *help, *option;
  const char* values;  // separated by bars; an empty one stands for the value on the command line
  RunPairs pairs;
};
constexpr Series kSeries[] = {
    {"widths", "packets of 1, 4, 8 and 16 as separate runs", "packet", "1|4|8|16", RunPairs::none},
    {"ab-effects", "kernels with the scene's effects and with every effect as two runs", "effects",
     "auto|all", RunPairs::effects},
    {"ab-shadow-cache", "without and with the shadow cache as two runs", "shadow-cache", "off|",
     RunPairs::shadowCache},
};
constexpr Series kOneRun{"", "", "", "", RunPairs::none};

struct BenchJob {
  CommonOptions common;
  std::vector<std::string> scenes;
  int frames = 0;  // 0: not given
  bool floor = false;
  std::array<bool, std::size(kSeries)> wanted{};
  std::string json;

  bool reference() const { return common.render.mode == Mode::reference; }
  // The reference takes seconds a frame, against which warming up is nothing.
  Turns turns() const {
    Turns turns;
    if (reference()) turns = {0, 1};
    if (frames > 0) turns.counted = frames;
    turns.floor = floor;
    return turns;
  }
  const Series& series() const {
    const auto i = static_cast<std::size_t>(std::ranges::find(wanted, true) - wanted.begin());
    return i < wanted.size() ? kSeries[i] : kOneRun;
  }
};

OptionList listOptions(BenchJob& job) {
  OptionList list;
  list.group("Measuring");
  list.value({"frames", "N", 1, 1e6}, "measured frames (20 after 3 to warm up; reference: 1)",
             job.frames);
  list.flag("floor", "also measure Embree alone on the same rays", job.floor);
  for (std::size_t i = 0; i < job.wanted.size(); ++i)
    list.flag(kSeries[i].flag, kSeries[i].help, job.wanted[i]);
  list.value({"json", "FILE"}, "all runs as JSON; - is standard output", job.json);
  listCommonOptions(list, job.common);
  list.operands("SCENE...", "scene files, models, or names of shipped scenes", 1,
                std::numeric_limits<std::size_t>::max(), job.scenes);
  return list;
}

void addRuns(BenchRuns& runs, const std::string& name, const BenchJob& job, Progress* progress) {
  const std::shared_ptr<const OpenScene> open = openScene(name, job.common, progress);
  const Series& series = job.series();
  bool caches = series.pairs == RunPairs::shadowCache;
  for (const std::string& value : split(series.values, '|')) {
    RenderOptions options = optionsToMeasure(open->scene, job.common);
    if (!value.empty()) setOption(options, series.option, value);
    caches |= &series == &kOneRun && options.shadowCache == ShadowCacheMode::audit;
    runs.push_back(std::make_unique<BenchRun>(open, job.common, options, progress));
  }
  if (caches) runs.back()->useShadowCache(job.common.load.maxMemoryBytes);
}

void checkJob(const BenchJob& job) {
  requireJsonWritable(job.json);
  const Series& series = job.series();
  const bool compares = &series != &kOneRun;
  refuseIf(job.reference() && (job.floor || compares),
           "--floor, --widths, --ab-effects and --ab-shadow-cache are for packets, not --mode "
           "reference");
  refuseIf(std::ranges::count(job.wanted, true) > 1,
           "--ab-shadow-cache, --ab-effects and --widths are runs of their own: give one of them");
  const bool isGiven = series.pairs == RunPairs::shadowCache
                           ? job.common.render.shadowCache == ShadowCacheMode::off
                           : job.common.given.contains(series.option);
  refuseIf(isGiven, std::string("--") + series.flag + " chooses --" + series.option +
                        " itself: leave that out");
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
  if (!parseOptions(kBenchUsage, kBenchSummary, listOptions(job), words)) return 0;
  checkJob(job);
  auto progress = makeProgressBar(job.common);
  std::vector<RunSummary> summaries;
  BenchRuns runs;
  for (std::size_t i = 0; i < job.scenes.size(); ++i) {
    addRuns(runs, job.scenes[i], job, progress.get());
    // Runs to be compared are held in memory together; others one after the other.
    if (&job.series() != &kOneRun && i + 1 < job.scenes.size()) continue;
    takeTurns(runs, job.turns(), progress.get());
    for (const auto& run : runs) summaries.push_back(run->summary());
    runs.clear();
  }
  progress.reset();
  FILE* const people = job.json == "-" ? stderr : stdout;
  if (people == stdout || !job.common.quiet) {
    for (const RunSummary& run : summaries) std::fprintf(people, "%s\n", stageTable(run).c_str());
    for (std::size_t i = 0; job.series().pairs != RunPairs::none && i + 1 < summaries.size();
         i += 2) {
      std::fprintf(people, "%s",
                   ratioText(job.series().pairs, summaries[i], summaries[i + 1]).c_str());
    }
  }
  if (!job.json.empty()) writeJson(job.json, benchJson(summaries, job.series().pairs));
  return 0;
}

}  // namespace whit::cli
