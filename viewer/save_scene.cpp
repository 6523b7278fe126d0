#include "viewer/save_scene.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "cli/app/interrupt.h"
#include "core/error.h"
#include "io/atomic_file.h"
#include "io/model.h"
#include "io/paths.h"
#include "io/read_file.h"
#include "io/scene/describe_scene.h"
#include "io/scene/distinct_names.h"
#include "io/scene/scene_settings.h"
#include "io/scene/scene_view.h"

namespace whit::view {

namespace fs = std::filesystem;

namespace {

std::string freeFile(const std::string& scene) {
  constexpr int kLimit = 9999;
  for (int i = 1; i <= kLimit; ++i) {
    std::string file = scene + "-edited" + (i == 1 ? "" : "-" + std::to_string(i)) + ".json";
    if (!fs::exists(file)) return file;
  }
  throwIo("'" + scene + "-edited-9999.json' is taken: there are too many in this folder");
}

void apply(const std::vector<std::string>& settings, const std::set<std::string>& but,
           JsonDocument& document) {
  for (const std::string& text : settings) {
    const SceneSetting setting = parseSceneSetting(text);
    if (!but.contains(setting.tokens.front())) applySceneSetting(setting, document);
  }
}

// Returns whether the sky is the one of the scene's file.
bool hasOwnSky(const SkyChoice& sky) { return sky.source.empty(); }

Json editedFile(const fs::path& path, const SceneName& name, const std::vector<std::string>& read,
                const ShadingEdit& edit) {
  JsonDocument document;
  document.file = path.string();
  document.root = parseJson(readTextFile(path, kJsonBytesLimit), document.file);
  apply(read, {}, document);
  for (const auto& [parameter, value] : name.parameters) {
    document.root["parameters"][parameter] = value;
  }
  apply(edit.settings, {}, document);
  if (!hasOwnSky(edit.sky)) document.root["sky"] = describeSky(edit.sky);
  return std::move(document.root);
}

// Cameras and lights were supplied, or come from the model's own file; a scene has to state them.
Json sceneOfModel(const fs::path& path, const std::vector<std::string>& read, const Scene& scene,
                  const ShadingEdit& edit) {
  Json root{{"whit", 1}, {"size", {scene.width, scene.height}}};
  std::vector<std::string> names;
  for (const Camera& camera : scene.cameras) names.push_back(camera.name);
  names = distinctNames(names);
  root["cameras"] = Json::object();
  for (std::size_t i = 0; i < names.size(); ++i) {
    root["cameras"][names[i]] = describe(scene.cameras[i]);
  }
  root["lights"] = describe(edit.lights);
  root["ambient"] = describe(edit.ambient);
  const std::set<std::string> inItem{"lights", "ambient", "sky"};
  JsonDocument item{path.string(), {{"model", path.filename().string()}}, {}};
  apply(read, inItem, item);
  apply(edit.settings, inItem, item);
  JsonDocument whole{path.string(), std::move(root), {}};
  const std::set<std::string> butSky{"lights", "ambient", "materials"};
  apply(read, butSky, whole);
  apply(edit.settings, butSky, whole);
  if (!hasOwnSky(edit.sky)) whole.root["sky"] = describeSky(edit.sky);
  whole.root["scene"] = Json::array({std::move(item.root)});
  return std::move(whole.root);
}

// Makes `camera` the first one, under a name of its own. The path's first keyframe states what it
// took from the old first camera.
void lookThrough(const Camera& camera, const Scene& scene, Json& root) {
  if (sameView(camera, scene.cameras.front())) return;
  const Json others = root.contains("cameras") ? root["cameras"] : Json::object();
  std::string name = "saved";
  for (int i = 2; others.contains(name); ++i) name = "saved " + std::to_string(i);
  Json cameras{{name, describe(camera)}};
  for (const auto& [known, value] : others.items()) cameras[known] = value;
  root["cameras"] = std::move(cameras);
  if (scene.cameraPath.empty()) return;
  Json& first = root["path"][0];
  const Json begin = describe(scene.cameraPath.front().camera);
  for (const auto& [key, value] : begin.items()) {
    if (!first.contains(key)) first[key] = value;
  }
}

}  // namespace

SavedScene saveScene(const LoadOptions& load, const std::string& name, const cli::OpenScene& scene,
                     const ShadingEdit& edit, const Camera& camera) {
  const SceneName parsed = parseSceneName(name);
  const fs::path path = findScene(parsed.file, load.shippedScenes);
  Json root = isModelFile(path) ? sceneOfModel(path, scene.settings, scene.scene, edit)
                                : editedFile(path, parsed, scene.settings, edit);
  lookThrough(camera, scene.scene, root);
  SavedScene saved;
  saved.file = freeFile(scene.scene.name);
  saved.leavesFolder = movePaths(root, path.parent_path(), ".");
  const cli::WriteScope scope;
  writeTextFile(saved.file, root.dump(2) + "\n");
  return saved;
}

}  // namespace whit::view
