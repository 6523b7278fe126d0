// A scene, and what it was read from.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "bake/scene.h"
#include "core/progress.h"
#include "core/warnings.h"
#include "io/image/image_file.h"
#include "io/load_scene.h"

namespace whit {

struct SceneSource {
  std::string name;                       // a scene file, a model, or a shipped scene
  std::shared_ptr<const SceneText> text;  // made by a program; null: the file `name` is read
};

struct OpenScene {
  explicit OpenScene(bool isStrict) : strict(isStrict), warnings(isStrict) {}
  OpenScene(const OpenScene& other);
  OpenScene& operator=(const OpenScene&) = delete;

  Scene scene;
  SceneSource source;
  LoadOptions load;  // with the settings (--set) of the scene as it is now
  bool strict;
  Warnings warnings;
  std::filesystem::file_time_type fileTime{};  // time of the scene's file before it was read
  double loadMs = 0;                           // reading and baking
  bool isMade = false;  // made or moved by a program: no command line opens it
  // Locked while the scene is moved to another time, if other threads read it.
  mutable std::mutex moving;
};

// Is called with the description of a scene before it is baked.
using LookAtScene = std::function<void(const SceneDescription&)>;

// Reads and bakes a scene. `strict`: the first thing that would be repaired is an error.
std::unique_ptr<OpenScene> openScene(const SceneSource& source, const LoadOptions& load,
                                     bool strict, Progress* progress = nullptr,
                                     const LookAtScene& look = {});

// Says that nothing in the scene gives light; empty if something does.
std::string noLightWarning(const Scene& scene);

// Adds the settings of LoadOptions with which the scene was read to the metadata of a picture.
void addSettings(const std::vector<std::string>& settings, const std::string& sky,
                 ImageMetadata& metadata);

}  // namespace whit
