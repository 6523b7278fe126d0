#include "cli/app/open_scene.h"

#include <cstdio>
#include <utility>

#include "core/formatted.h"
#include "core/option_table.h"
#include "core/stopwatch.h"
#include "io/load_scene.h"

namespace whit::cli {

std::unique_ptr<OpenScene> openScene(const std::string& name, const CommonOptions& common,
                                     Progress* progress, const LookAtScene& look) {
  const Stopwatch stopwatch;
  auto open = std::make_unique<OpenScene>(common.render.strict);
  SceneDescription description = loadScene(name, common.load, open->warnings, progress);
  if (look) look(description);
  open->scene = finalizeScene(name, std::move(description), open->warnings, progress);
  open->settings = common.load.settings;
  open->sky = common.load.sky;
  open->loadMs = stopwatch.ms();
  if (!common.quiet) tellWarnings(open->warnings);
  const EffectSet effects = open->scene.effects;
  const bool shines = effects.has(Effect::lights) || effects.has(Effect::sky) ||
                      effects.has(Effect::ambient) || effects.has(Effect::emission);
  if (!common.quiet && !shines) {
    std::fprintf(stderr,
                 "whit: warning: %s is black: it has no lights, no sky, no ambient light and no "
                 "emissive surface\n",
                 printable(open->scene.name).c_str());
  }
  return open;
}

RenderOptions optionsFor(const Scene& scene, const CommonOptions& common) {
  RenderOptions options = common.render;
  applySceneOptions(scene.options, common.given, options);
  return options;
}

RenderOptions optionsToMeasure(const Scene& scene, const CommonOptions& common) {
  return scene.isModel ? optionsFor(scene, common) : common.render;
}

void tellWarnings(const Warnings& warnings) {
  for (const auto& [kind, entry] : warnings.entries()) {
    std::fprintf(stderr, "whit: warning: %s (%llu times, first: %s)\n", printable(kind).c_str(),
                 static_cast<unsigned long long>(entry.count), printable(entry.first).c_str());
  }
}

}  // namespace whit::cli
