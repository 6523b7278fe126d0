#include "cli/app/open_scene.h"

#include <cstdio>
#include <utility>

#include "core/error.h"
#include "core/option_table.h"
#include "core/printable.h"
#include "core/stopwatch.h"
#include "io/load_scene.h"

namespace whit::cli {

std::unique_ptr<OpenScene> openScene(const std::string& name, const CommonOptions& common,
                                     Progress* progress, const LookAtScene& look) {
  const Stopwatch stopwatch;
  auto open = std::make_unique<OpenScene>(common.render.strict);
  SceneDescription description = loadScene(name, common.load, open->warnings, progress);
  if (look) look(description);
  try {
    open->scene = Scene::finalize(std::move(description), open->warnings, progress);
  } catch (const Error& error) {  // it names the scene, and not its file
    if (error.status() != ExitStatus::badScene) throw;
    throw Error(error.status(), name + ": " + error.what(),
                {name, error.place().place, error.place().expected});
  }
  open->settings = common.load.settings;
  open->sky = common.load.sky;
  open->loadMs = stopwatch.ms();
  if (!common.quiet) tellWarnings(open->warnings);
  return open;
}

RenderOptions optionsFor(const Scene& scene, const CommonOptions& common) {
  RenderOptions options = common.render;
  if (scene.isModel) applyModelDefaults(options, common.given);
  return options;
}

void tellWarnings(const Warnings& warnings) {
  for (const auto& [kind, entry] : warnings.entries()) {
    std::fprintf(stderr, "whit: warning: %s (%llu times, first: %s)\n", printable(kind).c_str(),
                 static_cast<unsigned long long>(entry.count), printable(entry.first).c_str());
  }
}

Film openFilm(const Scene& scene, const CommonOptions& common) {
  return makeFilm(scene, common.render, common.load.maxMemoryBytes);
}

void checkShared(const Farm& farm, const CommonOptions& common) {
  if (farm.ranks() > 1 && common.render.batch == Batch::frame) {
    throwUsage("--batch frame needs the whole image in one process: leave it out, or mpirun");
  }
}

void quietUnlessLeading(const Farm& farm, CommonOptions& common) {
  if (!farm.leads()) common.quiet = true;
}

FrameStats renderShared(Farm& farm, Renderer& renderer, const RenderOptions& options,
                        const Camera& camera, Film& film, Progress* progress) {
  if (farm.ranks() > 1) progress = nullptr;  // of the leader's blocks, which are a part
  return farm.render(film, options.tile, renderer.machine().threads, [&](Film& part) {
    return renderFrame(renderer, options.mode, camera, part, progress);
  });
}

}  // namespace whit::cli
