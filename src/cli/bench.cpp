// whit bench: how long a frame takes, by stage and by kind of ray.
#include <algorithm>
#include <array>
#include <cstdio>
#include <iterator>
#include <nlohmann/json.hpp>

#include "cli/bench_run.h"
#include "cli/commands.h"
#include "command_line/progress_bar.h"
#include "core/error.h"
#include "core/index.h"
#include "core/machine_limits.h"
#include "core/option_table.h"
#include "core/text.h"
#include "output/image_output.h"
#include "output/json_report.h"
#include "output/open_and_warn.h"
#include "output/report_page.h"

namespace whit::cli {

namespace {

constexpr const char* kBenchUsage = "whit bench SCENE... [options]";
constexpr const char* kBenchSummary =
    "Measures the time of frames by stage and by kind of ray. The frames of the runs of --widths, "
    "--threads-scaling and the --ab options take turns, so that other load of the machine affects "
    "all of them alike. Where the kernel lets a program read the processor's counters "
    "(perf_event_paranoid), instructions, cycles and cache misses for a ray are told too.";

// An option whose values are measured as separate runs, which take turns.
struct Series {
  const char *flag, *help, *option;
  // Values, separated by bars. "..." stands for the powers of two below the number of usable
  // threads and that number; an empty value stands for the value on the command line.
  const char* values;
  bool isPair = false;  // the second run is compared with the first
};
constexpr Series kSeries[] = {
    {"widths", "packets of 1, 4, 8 and 16 as separate runs", "packet", "1|4|8|16"},
    {"threads-scaling", "1, 2, 4, ... threads as separate runs, with speed-up and efficiency",
     "threads", "..."},
    {"ab-effects", "plans for the scene's effects and for every effect as two runs", "effects",
     "auto|all", true},
};
constexpr Series kOneRun{"", "", "", ""};

struct BenchJob {
  CommonOptions common;
  std::vector<std::string> scenes;
  int frames = 0;  // 0: not given
  bool floor = false;
  std::array<bool, std::size(kSeries)> wanted{};
  std::string json, csv;

  bool reference() const { return common.render.mode == Mode::reference; }
  // The reference takes seconds a frame, so frames to warm up would change nothing.
  TurnCounts turns() const {
    TurnCounts turns;
    if (reference()) turns = {0, 1};
    if (frames > 0) turns.counted = frames;
    turns.floor = floor;
    return turns;
  }
  const Series& series() const {
    const std::size_t i = std::ranges::find(wanted, true) - wanted.begin();
    return i < wanted.size() ? kSeries[i] : kOneRun;
  }
};

OptionList listOptions(BenchJob& job) {
  OptionList list;
  list.group("Measuring");
  list.value({"frames", "N", 1, 1e6}, "measured frames (20 after 3 to warm up; reference: 1)",
             job.frames);
  list.flag("floor", "also measure Embree alone on the same rays", job.floor);
  for (const auto i : indices(job.wanted))
    list.flag(kSeries[i].flag, kSeries[i].help, job.wanted[i]);
  list.value({"json", "FILE"}, "all runs as JSON; - is standard output", job.json);
  list.value({"csv", "FILE"}, "all runs as a table, a line each; - is standard output", job.csv);

  listCommonOptions(list, job.common);
  list.operands("SCENE...", "scene files, models, or names of shipped scenes", 1,
                OptionList::kAnyNumber, job.scenes);
  return list;
}

std::vector<std::string> valuesOf(const Series& series) {
  std::vector<std::string> values = split(series.values, '|');
  if (values[0] != "...") return values;

  values.clear();
  for (int n = 1; n < usableThreads(); n *= 2) values.push_back(std::to_string(n));
  values.push_back(std::to_string(usableThreads()));
  return values;
}

void addRuns(BenchRuns& runs, const std::string& name, const BenchJob& job, Progress* progress) {
  const std::shared_ptr<OpenScene> open = openAndWarn(name, job.common, progress);
  const Series& series = job.series();

  for (const std::string& value : valuesOf(series)) {
    RenderOptions options = optionsToMeasure(open->scene, job.common);
    if (!value.empty()) setOption(options, series.option, value);
    const std::string name = value.empty() ? "" : series.option + (" " + value);
    runs.push_back(std::make_unique<BenchRun>(open, options, progress, name));
  }
}

void checkJob(const BenchJob& job) {
  requireJsonWritable(job.json);
  if (!job.csv.empty() && job.csv != "-") requireWritable(job.csv, {".csv"});
  requireSeparateFiles({job.json, job.csv}, job.common, job.scenes);
  const Series& series = job.series();
  const bool compares = &series != &kOneRun;
  refuseIf(job.reference() && (job.floor || compares),
           "--floor, --widths, --threads-scaling and --ab-effects are for packets, not --mode "
           "reference");
  refuseIf(std::ranges::count(job.wanted, true) > 1,
           "--ab-effects, --threads-scaling and --widths are runs of their own: give one of them");
  refuseIf(
      job.common.given.contains(series.option),
      std::string("--") + series.flag + " chooses --" + series.option + " itself: leave that out");
}

// A table of the speed-up over one thread, and of the speed-up for each thread (efficiency).
std::string scalingText(const std::vector<RunSummary>& runs) {
  std::string text = "threads        ms  speed-up  efficiency %\n";
  double alone = 0;
  for (const RunSummary& run : runs) {
    const int threads = run.machine.threads;
    // Speed-up refers to the run of the same scene with one thread, which comes first.
    const double ms = medianFrame(run).frameMs;
    if (threads == 1) alone = ms;
    text += formatted("%7d%10.2f%10.2f%14.1f  %s\n", threads, ms, alone / ms,
                      100 * alone / ms / threads, run.scene.c_str());
  }
  return text;
}

// Returns all runs. Runs that come in pairs add the ratio of the second run to the first.
Json benchJson(const std::vector<RunSummary>& runs, bool arePairs) {
  Json json{{"machine", machineJson(runs.at(0).machine)}};
  json["runs"] = Json::array();
  for (const RunSummary& run : runs) json["runs"].push_back(runJson(run));

  if (!arePairs) return json;
  for (std::size_t i = 0; i + 1 < runs.size(); i += 2) {
    const RunRatio ratio = ratioOf(runs[i + 1], runs[i]);
    json["all_over_auto"].push_back({{"scene", runs[i].scene},
                                     {"frame", ratio.frame},
                                     {"outside_embree", ratio.outsideEmbree}});
  }
  return json;
}

// A line for each run, with a column for each number in the JSON: "frame_ms_median".
std::string benchCsv(const std::vector<RunSummary>& runs) {
  Json rows = Json::array();
  for (const RunSummary& run : runs) {
    // Lists and options may differ from scene to scene, and all lines have the same columns.
    Json all = runJson(run), row;
    all["size"] = formatted("%dx%d", run.width, run.height);
    all.erase("options");
    all.erase("effects");

    const Json flat = all.flatten();
    for (const auto& [pointer, value] : flat.items()) {
      std::string column = pointer.substr(1);
      std::ranges::replace(column, '/', '_');
      row[column] = value;
    }
    rows.push_back(std::move(row));
  }
  return csvOf(rows);
}

}  // namespace

int benchCommand(const Words& words) {
  BenchJob job;
  if (!parseOptions(kBenchUsage, kBenchSummary, listOptions(job), words)) return 0;
  checkJob(job);
  auto progress = makeProgressBar(job.common);
  processorCounters();  // opened before the threads start whose events they count

  std::vector<RunSummary> summaries;
  BenchRuns runs;

  for (const auto i : indices(job.scenes)) {
    addRuns(runs, job.scenes[i], job, progress.get());
    // Runs that are compared are held in memory together; other scenes are held one at a time.
    if (&job.series() != &kOneRun && i + 1 < job.scenes.size()) continue;
    measureInTurn(runs, job.turns(), progress.get());
    for (const auto& run : runs) summaries.push_back(run->summary());
    runs.clear();
  }
  progress.reset();

  // Where JSON or CSV takes standard output, the tables for people go to standard error.
  FILE* const people = job.json == "-" || job.csv == "-" ? stderr : stdout;
  if (people == stdout || !job.common.quiet) {
    for (const RunSummary& run : summaries) {
      std::fprintf(people, "%s\n", stageTable(run).c_str());
      printPictureWarnings(run);
    }
    if (std::string_view(job.series().option) == "threads") {
      std::fprintf(people, "%s", scalingText(summaries).c_str());
    }
    for (std::size_t i = 0; job.series().isPair && i + 1 < summaries.size(); i += 2) {
      std::fprintf(people, "%s", ratioText(summaries[i], summaries[i + 1]).c_str());
    }
  }

  if (!job.json.empty()) writeJson(job.json, benchJson(summaries, job.series().isPair));
  if (!job.csv.empty()) writeReport(job.csv, benchCsv(summaries));
  printWrittenFiles({job.json, job.csv}, job.common);
  return 0;
}

}  // namespace whit::cli
