// whit accuracy: measures time and error with one knob of accuracy changed at a time.
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "accuracy/report.h"
#include "accuracy/sweep.h"
#include "cli/commands.h"
#include "command_line/program.h"
#include "command_line/progress_bar.h"
#include "core/error.h"
#include "core/text.h"
#include "engine/engine.h"
#include "io/files.h"
#include "output/image_output.h"
#include "output/json_report.h"
#include "output/open_and_warn.h"
#include "output/report_page.h"

namespace whit::cli {

namespace {

constexpr const char* kAccuracyUsage = "whit accuracy SCENE... --out DIR [--full] [options]";
constexpr const char* kAccuracySummary =
    "Renders each scene with one knob of accuracy changed at a time, and says what that costs in\n"
    "time and in error against a double-precision reference, or against a picture with all light\n"
    "that can be transported. Writes DIR/report.html, a page with charts, pictures and tables, "
    "and\n"
    "DIR/sweep.csv.";
constexpr ImageSize kQuickSize{256, 256};
constexpr const char *kAccuracyTable = "sweep.csv", *kAccuracyPage = "report.html";

struct AccuracyJob {
  CommonOptions common;
  std::vector<std::string> scenes;
  std::string out, knobs;
  int seed = 1;
  accuracy::SweepSettings settings;
};

std::string knobHelp() {
  return "knobs to sweep (default: all: " + joined(namesIn(allKnobs())) + ")";
}

OptionList listOptions(AccuracyJob& job) {
  OptionList list;
  list.group("Measuring");
  list.value({"out", "DIR"}, "folder for the results; it is made if it does not exist", job.out);
  list.value({"truth", "model|transport"},
             "what errors are measured against: Whitted's model without approximations, or all "
             "transport of light, with points from one sample to that",
             job.settings.truth);
  list.flag("full",
            "the scene's size and 256 reference samples, in place of 256x256 pixels, up to 64 "
            "reference samples and points until a minute is over",
            job.settings.full);
  list.value({"knobs", "a,b"}, knobHelp(), job.knobs);
  list.value(
      {"time-budget", "SECONDS", 0, 1e6},
      "time for measuring times of a scene until their spread is known; the reference takes at "
      "most a third of it besides (default: 20, --full 600)",
      job.settings.timingSeconds);
  list.value({"reference-spp", "N", 1, 65536},
             "samples a pixel of the reference, which then do not depend on the time that it takes",
             job.settings.referenceSpp);
  list.value({"seed", "N", 0, 1e9}, "seed of the random order of the measurements", job.seed);

  listCommonOptions(list, job.common);
  list.operands("SCENE...", "scene files, models, or names of shipped scenes", 1,
                OptionList::kAnyNumber, job.scenes);
  return list;
}

void checkJob(AccuracyJob& job) {
  if (job.out.empty()) throwUsage("whit accuracy expected --out DIR");
  accuracy::SweepSettings& settings = job.settings;
  refuseIf(job.common.render.mode == Mode::reference,
           "whit accuracy measures packets against the reference: leave out --mode");

  if (!job.knobs.empty()) settings.knobs = split(job.knobs, ',');
  chooseKnobs(settings.knobs);
  if (!settings.full && !job.common.render.size) job.common.render.size = kQuickSize;
  settings.seed = job.seed;
  makeFolder(job.out, {kAccuracyTable, kAccuracyPage});
}

// Automatic exposure is computed once, so that all pictures of a sweep have the same.
RenderOptions sweptOptions(const std::shared_ptr<OpenScene>& open, const CommonOptions& common) {
  RenderOptions options = optionsToMeasure(open->scene, common);
  if (!options.exposure.automatic) return options;

  Engine engine(open);
  engine.setOptions(options);
  engine.prepare();
  return engine.options();
}

std::vector<accuracy::SceneSweep> sweepScenes(const AccuracyJob& job) {
  auto progress = makeProgressBar(job.common);
  std::vector<accuracy::SceneSweep> sweeps;
  for (const std::string& name : job.scenes) {
    const std::shared_ptr<OpenScene> open = openAndWarn(name, job.common, progress.get());
    const RenderOptions options = sweptOptions(open, job.common);
    makeFilm(open->scene, options, job.common.load.maxMemoryBytes);  // throws if it does not fit
    sweeps.push_back(sweepScene(open->scene, options, job.settings, progress.get()));
  }
  return sweeps;
}

}  // namespace

int accuracyCommand(const Words& words) {
  AccuracyJob job;
  if (!parseOptions(kAccuracyUsage, kAccuracySummary, listOptions(job), words)) return 0;

  checkJob(job);
  const std::vector<accuracy::SceneSweep> sweeps = sweepScenes(job);

  // Both files say how and where the measurements were made.
  const Machine& machine = sweeps[0].machine;
  Json facts{{"sweep", job.settings.full ? "full" : "quick"},
             {"seed", job.settings.seed},
             {"threads", machine.threads}};
  facts.update(machineJson(machine));

  for (const accuracy::SceneSweep& sweep : sweeps)
    std::printf("%s\n", accuracy::sweepTable(sweep, job.settings.seed).c_str());

  const WriteScope scope;
  const std::filesystem::path folder(job.out);
  const std::string table = folder / kAccuracyTable, page = folder / kAccuracyPage;
  writeTextFile(table, accuracy::sweepCsv(sweeps, facts));
  writeTextFile(page, reportPage(accuracy::reportJson(sweeps, facts)));
  printWrittenFiles({table, page}, job.common);
  return 0;
}

}  // namespace whit::cli
