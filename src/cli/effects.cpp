// whit effects: measures a scene as a matte one and then with one effect more at a time.
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/bench_run.h"
#include "cli/commands.h"
#include "cli/effects_report.h"
#include "command_line/program.h"
#include "command_line/progress_bar.h"
#include "core/error.h"
#include "core/index.h"
#include "core/text.h"
#include "engine/open_scene.h"
#include "io/files.h"
#include "io/load_scene.h"
#include "make/leave_out.h"
#include "output/image_output.h"
#include "output/json_report.h"
#include "output/open_and_warn.h"
#include "output/report_page.h"

namespace whit::cli {

namespace {

constexpr const char* kEffectsUsage = "whit effects [SCENE] --out DIR [options]";
constexpr const char* kEffectsSummary =
    "Measures a scene with nothing but point lights and their shadows, then with one effect more\n"
    "at a time until it is complete. The frames of all steps take turns. Writes DIR/report.html,\n"
    "DIR/effects.csv and a picture of each step: DIR/00-matte.png, DIR/01-sky.png ...";
constexpr const char *kEffectsTable = "effects.csv", *kEffectsPage = "report.html";

struct EffectsJob {
  CommonOptions common;
  std::vector<std::string> scenes;
  std::string out;
  int frames = 20;
};

std::shared_ptr<OpenScene> openStep(const SceneDescription& whole, EffectSet kept,
                                    const EffectsJob& job) {
  auto open = std::make_shared<OpenScene>(job.common.render.strict);
  open->load = job.common.load;

  // The scene is baked as if its description had none of the other effects.
  SceneDescription description = whole;
  leaveOut(description, EffectSet::all().without(kept));
  open->scene = Scene::finalize(std::move(description), open->warnings);
  return open;
}

std::string pictureName(const std::vector<EffectStep>& steps, std::size_t i) {
  return formatted("%02zu-%s.png", i, steps[i].added.c_str());
}

// Measures a step for each effect that the scene has, because the others would add nothing, and
// saves its picture.
std::vector<EffectStep> measureSteps(const EffectsJob& job, Progress* progress) {
  Warnings warnings(job.common.render.strict);
  const std::string name = job.scenes.empty() ? "effects" : job.scenes[0];
  const SceneDescription whole = loadScene(name, job.common.load, warnings, progress);
  printWarnings(warnings);

  const EffectSet has = openStep(whole, EffectSet::all(), job)->scene.effects;
  std::vector<EffectStep> steps;
  BenchRuns runs;
  const auto add = [&](std::string_view added, EffectSet kept) {
    steps.push_back({std::string(added), {}, 0});
    const std::shared_ptr<OpenScene> step = openStep(whole, kept, job);
    runs.push_back(
        std::make_unique<BenchRun>(step, optionsToMeasure(step->scene, job.common), progress));
  };

  // Each step keeps the effects of the step before and adds one.
  EffectSet kept = kMatteEffects;
  add("matte", kept);
  for (const Effect effect : kAddedEffects) {
    kept = kept.with(effect);
    const bool isOff = optionalEffectsOff(job.common.render).has(effect);
    if (has.has(effect) && !isOff) add(nameOf(effect), kept);
  }

  // The frames of all steps take turns, so that other load of the machine affects all alike.
  measureInTurn(runs, TurnCounts{3, job.frames, false}, progress);
  for (const auto i : indices(steps)) {
    steps[i].run = runs[i]->summary();
    steps[i].memoryMb = runs[i]->memoryMb();
    const std::string file = std::filesystem::path(job.out) / pictureName(steps, i);
    requireSeparateFiles({file}, job.common, job.scenes);
    writeImage(file, runs[i]->film(), {{"scene", name}, {"effects", "up to " + steps[i].added}});
  }
  return steps;
}

void checkJob(const EffectsJob& job) {
  refuseIf(job.out.empty(), "whit effects expected --out DIR");
  refuseIf(job.common.render.mode == Mode::reference,
           "whit effects measures packets: leave out --mode reference");
  refuseIf(job.common.given.contains("effects") || job.common.given.contains("disable"),
           "whit effects chooses the effects itself: leave out --effects and --disable");
  makeFolder(job.out, {kEffectsTable, kEffectsPage});
}

}  // namespace

int effectsCommand(const Words& words) {
  EffectsJob job;
  OptionList list;
  list.group("Measuring");
  list.value({"out", "DIR"}, "folder for the results; it is made if it does not exist", job.out);
  list.value({"frames", "N", 1, 1e6}, "number of frames that are measured for each step",
             job.frames);
  listCommonOptions(list, job.common);
  list.operands("SCENE", "a scene file, or the name of a shipped scene (effects)", 0, 1,
                job.scenes);

  if (!parseOptions(kEffectsUsage, kEffectsSummary, list, words)) return 0;
  checkJob(job);

  auto progress = makeProgressBar(job.common);
  const std::vector<EffectStep> steps = measureSteps(job, progress.get());
  progress.reset();

  std::vector<std::string> pictures;
  for (const auto i : indices(steps)) pictures.push_back(pictureName(steps, i));
  const Json report = effectsJson(steps, pictures);
  std::fputs(effectsTable(report).c_str(), stdout);

  const WriteScope scope;
  const std::filesystem::path folder(job.out);
  const std::string table = folder / kEffectsTable, page = folder / kEffectsPage;
  writeTextFile(table, csvOf(report["effects"]));
  writeTextFile(page, reportPage(report));
  printWrittenFiles({table, page}, job.common);
  return 0;
}

}  // namespace whit::cli
