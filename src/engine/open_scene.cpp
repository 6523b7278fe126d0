#include "engine/open_scene.h"

#include "core/stopwatch.h"
#include "core/text.h"

namespace whit {

OpenScene::OpenScene(const OpenScene& other)
    : scene(other.scene),
      source(other.source),
      load(other.load),
      strict(other.strict),
      warnings(other.strict),
      fileTime(other.fileTime),
      loadMs(other.loadMs),
      isMade(other.isMade) {
  // Warnings hold a mutex, so that they are copied entry by entry.
  for (const auto& [kind, entry] : other.warnings.entries()) {
    warnings.note(kind, entry.first, entry.count);
  }
}

std::unique_ptr<OpenScene> openScene(const SceneSource& source, const LoadOptions& load,
                                     bool strict, Progress* progress, const LookAtScene& look) {
  const Stopwatch stopwatch;
  auto open = std::make_unique<OpenScene>(strict);
  if (!source.text) {
    open->fileTime = timeOf(findScene(parseSceneName(source.name).file, load.shippedScenes));
  }

  SceneDescription description = source.text
                                     ? loadScene(*source.text, load, open->warnings, progress)
                                     : loadScene(source.name, load, open->warnings, progress);
  // The callback sees the description as it was read, before it is baked.
  if (look) look(description);

  open->scene = finalizeScene(source.name, std::move(description), open->warnings, progress);
  open->source = source;
  open->load = load;
  open->isMade = source.text != nullptr;
  open->loadMs = stopwatch.ms();
  return open;
}

std::string noLightWarning(const Scene& scene) {
  for (const Effect effect : {Effect::lights, Effect::sky, Effect::ambient, Effect::emission}) {
    if (scene.effects.has(effect)) return "";
  }
  if (scene.effects.has(Effect::fog) && scene.fog.color != Rgb(0.0f)) return "";
  return scene.name +
         " is black: it has no lights, no sky, no ambient light, no emissive surface and no "
         "colored fog";
}

void addSettings(const std::vector<std::string>& settings, const std::string& sky,
                 ImageMetadata& metadata) {
  // The metadata have one entry for all settings, a line for each.
  if (!settings.empty()) metadata.emplace_back("set", joined(settings, "\n"));
  if (!sky.empty()) metadata.emplace_back("sky", sky);
}

}  // namespace whit
