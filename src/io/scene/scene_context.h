// The state of a scene's reading, which the readers of its sections share.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "core/progress.h"
#include "core/warnings.h"
#include "io/load_scene.h"
#include "io/memory_budget.h"
#include "io/model.h"
#include "io/paths.h"
#include "io/read_file.h"
#include "io/scene/scene_parts.h"
#include "io/texture_loader.h"
#include "scene/description.h"

namespace whit {

struct SceneContext {
  SceneContext(const std::filesystem::path& file, const LoadOptions& options, Warnings& warnings_,
               Progress* progress_)
      : folder(file.parent_path()),
        rules(folder, options.allowOutside),
        budget(options.maxMemoryBytes),
        warnings(warnings_),
        progress(progress_),
        sky(options.sky),
        instant(options.instant),
        textures(options.threads, budget, warnings, progress) {
    scene.name = file.stem().string();
  }

  // The model at `path`, which `where` names, opened once.
  Model& model(const std::filesystem::path& path, const std::string& where) {
    std::unique_ptr<Model>& entry = models[path.string()];
    if (entry) return *entry;
    entry = readNamedAt(where, [&] { return openModel({path, rules, budget, warnings, instant}); });
    for (const Animation& animation : entry->animations()) scene.animations.push_back(animation);
    return *entry;
  }

  std::filesystem::path folder;
  PathRules rules;
  MemoryBudget budget;
  Warnings& warnings;
  Progress* progress;
  SceneDescription scene;
  const SceneParts* parts = nullptr;  // of a scene that a program makes
  std::string sky;                    // this and the next as in LoadOptions
  Instant instant;
  std::map<std::string, std::unique_ptr<Model>> models;
  TextureLoader textures;  // last: its workers write to the scene
};

}  // namespace whit
