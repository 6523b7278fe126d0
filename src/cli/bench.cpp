// whit bench: how long a frame takes, by stage and by kind of ray.
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/image_output.h"
#include "cli/json_report.h"
#include "cli/open_scene.h"
#include "cli/progress_bar.h"
#include "cli/stage_table.h"
#include "core/error.h"

namespace whit::cli {

namespace {

constexpr const char* kUsage = "whit bench SCENE... [options]";
constexpr const char* kSummary =
    "Renders frames and says where their time goes. With --widths the frames of all runs take\n"
    "turns, so that whatever else the machine does hits all of them alike.";
constexpr int kWarmUpFrames = 3;
constexpr int kWidths[] = {1, 4, 8, 16};

struct BenchJob {
  CommonOptions common;
  std::vector<std::string> scenes;
  int frames = 0;  // 0: not given
  bool floor = false, widths = false;
  std::string json;

  bool reference() const { return common.render.mode == Mode::reference; }
  // The reference takes seconds a frame, against which warming up is nothing.
  int countedFrames() const { return frames > 0 ? frames : reference() ? 1 : 20; }
  int warmUpFrames() const { return reference() ? 0 : kWarmUpFrames; }
};

OptionList listOptions(BenchJob& job) {
  OptionList list;
  list.group("Measuring");
  list.value({"frames", "N", 1, 1e6}, "frames that count (20 after 3 to warm up; reference: 1)",
             job.frames);
  list.flag("floor", "also what Embree alone needs for the same rays", job.floor);
  list.flag("widths", "packets of 1, 4, 8 and 16 as separate runs", job.widths);
  list.value({"json", "FILE"}, "all runs for machines; - is standard output", job.json);
  listCommonOptions(list, job.common);
  list.operands("SCENE...", "scene files, models, or names of shipped scenes", 1,
                std::numeric_limits<std::size_t>::max(), job.scenes);
  return list;
}

// A scene with one choice of options.
class BenchRun {
 public:
  BenchRun(std::shared_ptr<const OpenScene> open, const BenchJob& job, const RenderOptions& options,
           Progress* progress)
      : open_(std::move(open)),
        options_(options),
        renderer_(open_->scene, options, progress),
        camera_(chooseCamera(open_->scene, options)),
        film_(openFilm(open_->scene, job.common)),
        summary_(summarise(open_->scene, options, renderer_, film_, open_->loadMs)) {}

  void warmUp() { renderFrame(renderer_, options_.mode, camera_, film_); }
  void measure(bool floor) {
    summary_.frames.push_back(renderFrame(renderer_, options_.mode, camera_, film_));
    if (floor) summary_.floorMs.push_back(renderer_.measureFloor(camera_, film_, 1).floorMs);
  }
  const RunSummary& summary() const { return summary_; }

 private:
  std::shared_ptr<const OpenScene> open_;
  RenderOptions options_;
  Renderer renderer_;
  Camera camera_;
  Film film_;
  RunSummary summary_;
};

using BenchRuns = std::vector<std::unique_ptr<BenchRun>>;

void addRuns(BenchRuns& runs, const std::string& name, const BenchJob& job, Progress* progress) {
  const std::shared_ptr<const OpenScene> open = openScene(name, job.common, progress);
  if (!job.widths) {
    runs.push_back(std::make_unique<BenchRun>(open, job, job.common.render, progress));
    return;
  }
  for (const int width : kWidths) {
    RenderOptions options = job.common.render;
    options.packet = width;
    runs.push_back(std::make_unique<BenchRun>(open, job, options, progress));
  }
}

// One frame of each run in turn; a floor right after its frame.
void takeTurns(const BenchRuns& runs, const BenchJob& job, Progress* progress) {
  for (int i = 0; i < job.warmUpFrames(); ++i) {
    for (const auto& run : runs) run->warmUp();
  }
  for (int i = 0; i < job.countedFrames(); ++i) {
    reportProgress(progress, "measuring", static_cast<double>(i) / job.countedFrames());
    for (const auto& run : runs) run->measure(job.floor);
  }
}

void checkJob(const BenchJob& job) {
  requireJsonWritable(job.json);
  if (job.reference() && job.floor) throwUsage("--floor is for packets, not --mode reference");
  if (job.reference() && job.widths) throwUsage("--widths is for packets, not --mode reference");
  if (job.widths && job.common.given.contains("packet")) {
    throwUsage("--widths runs every packet width: leave out --packet");
  }
}

}  // namespace

int benchCommand(const Words& words) {
  BenchJob job;
  if (parseOptions(kUsage, kSummary, listOptions(job), words) == Parsed::helpShown) return 0;
  settleOptions(job.common);
  checkJob(job);
  auto progress = makeProgressBar(!job.common.quiet && job.common.progress == "auto");
  std::vector<RunSummary> summaries;
  BenchRuns runs;
  for (std::size_t i = 0; i < job.scenes.size(); ++i) {
    addRuns(runs, job.scenes[i], job, progress.get());
    // Runs to be compared are held in memory together; others one after the other.
    if (job.widths && i + 1 < job.scenes.size()) continue;
    takeTurns(runs, job, progress.get());
    for (const auto& run : runs) summaries.push_back(run->summary());
    runs.clear();
  }
  progress.reset();
  FILE* const people = job.json == "-" ? stderr : stdout;
  if (people == stdout || !job.common.quiet) {
    for (const RunSummary& run : summaries) std::fprintf(people, "%s\n", stageTable(run).c_str());
  }
  if (!job.json.empty()) writeJson(job.json, benchJson(summaries));
  return 0;
}

}  // namespace whit::cli
