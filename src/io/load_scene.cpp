#include "io/load_scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/nearest_name.h"
#include "io/json_reader.h"
#include "io/paths.h"
#include "io/read_file.h"
#include "io/scene/scene_context.h"
#include "io/scene/scene_items.h"
#include "io/scene/scene_materials.h"
#include "io/scene/scene_settings.h"
#include "io/scene/scene_view.h"
#include "io/supply_view.h"
#include "make/shapes/generators.h"
#include "scene/generation_limit.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

constexpr int kSchemaVersion = 1;

std::vector<SceneSetting> parseSettings(const LoadOptions& options) {
  std::vector<SceneSetting> settings;
  for (const std::string& text : options.settings) settings.push_back(parseSceneSetting(text));
  return settings;
}

// The scene's own values, then those that were given with its name.
void readParameters(JsonObject& file, const std::map<std::string, double>& given,
                    JsonDocument& document) {
  std::vector<std::string> names;
  if (const auto parameters = file.find("parameters")) {
    std::map<std::string, double> values;  // apart: parameters do not refer to each other
    for (const auto& [name, value] : parameters->members()) {
      values[name] = value.number();
      names.push_back(name);
    }
    document.parameters = std::move(values);
  }
  for (const auto& [name, value] : given) {
    const auto known = document.parameters.find(name);
    if (known == document.parameters.end()) {
      const std::string nearest = nearestName(name, names);
      throwUsage(document.file + " has no parameter \"" + name + "\"" +
                 (nearest.empty() ? std::string() : "; did you mean \"" + nearest + "\"?"));
    }
    if (!(std::abs(value) <= kLargestNumber)) {
      throwUsage("parameter \"" + name + "\" is beyond what a scene can hold");
    }
    known->second = value;
  }
}

void finishTextures(SceneContext& context, std::optional<double> ambientFromSkyStrength) {
  context.textures.finish(context.scene);
  if (ambientFromSkyStrength) {
    context.scene.ambient =
        ambientFromSky(context.scene.sky, *ambientFromSkyStrength, context.scene.ambient);
  }
}

// Before all others.
void addPathCamera(SceneDescription& scene) {
  Camera camera = scene.cameraPath.front().camera;
  camera.name = "path";
  const auto taken = [](const Camera& other) { return other.name == "path"; };
  if (std::any_of(scene.cameras.begin(), scene.cameras.end(), taken))
    camera.name += " of the scene";
  scene.cameras.insert(scene.cameras.begin(), camera);
  for (MovingCamera& moving : scene.motion.cameras) ++moving.camera;
  scene.motion.cameras.push_back({0, kNoNode, camera});
}

bool has(const Rig& rig, const std::string& name) {
  return std::any_of(rig.begin(), rig.end(),
                     [&](const RigNode& n) { return !n.name.empty() && n.name == name; });
}

void requireMovable(const std::string& pointer, const SceneDescription& scene) {
  if (has(scene.motion.rig, pointer)) return;
  for (const Object& object : scene.objects) {
    for (const Mesh& mesh : object.meshes) {
      if (!mesh.deformation || !mesh.deformation->hasSkin()) continue;
      if (has(*mesh.deformation->skeleton, pointer)) return;
    }
  }
  throwUsage("\"" + pointer + "\" is not in " + scene.name +
             ", or not what can be moved: an item, a camera or a light of a scene file, or a node "
             "of a glTF model that holds something");
}

// The instant that was asked for is one of something that moves.
void settleInstant(const Instant& instant, SceneDescription& scene) {
  std::vector<std::string> names;
  for (const Animation& animation : scene.animations) names.push_back(animation.name);
  const bool known = std::find(names.begin(), names.end(), instant.animation) != names.end();
  if (!instant.animation.empty() && !known) {
    const std::string nearest = nearestName(instant.animation, names);
    throwUsage(scene.name + " has no animation \"" + instant.animation + "\"" +
               (nearest.empty() ? std::string() : "; did you mean \"" + nearest + "\"?"));
  }
  scene.motion.seconds = instant.seconds.value_or(0);
  if (instant.seconds && scene.cameraPath.empty() && names.empty()) {
    throwUsage("--time: nothing moves in " + scene.name);
  }
  if (instant.fliesPath() && !scene.cameraPath.empty()) addPathCamera(scene);
  for (const std::string& pointer : instant.movable) requireMovable(pointer, scene);
}

void replaceSpheres(int segments, SceneContext& context) {
  constexpr int kLeast = 4;
  if (segments == 0) return;
  if (segments < kLeast) {
    throwUsage("--sphere-segments expected 0 or at least " + std::to_string(kLeast) + ", found " +
               std::to_string(segments));
  }
  const GenerationLimit limit(context.budget.left());
  for (Object& object : context.scene.objects) {
    for (Mesh& mesh : object.meshes) procedural::tessellateSpheres(mesh, segments);
  }
}

// With the settings and parameters.
JsonDocument documentOf(const std::string& name, Json root,
                        const std::map<std::string, double>& parameters,
                        const LoadOptions& options) {
  JsonDocument document{name, std::move(root), {}};
  for (const SceneSetting& setting : parseSettings(options)) applySceneSetting(setting, document);
  JsonObject file{JsonValue(document)};
  file.need("whit").integer(kSchemaVersion, kSchemaVersion);
  readParameters(file, parameters, document);
  return document;
}

JsonDocument documentOf(const fs::path& path, const SceneName& name, const LoadOptions& options) {
  parseSettings(options);  // what is said beside the file is judged before it
  Json root = parseJson(readTextFile(path, kJsonBytesLimit), path.string());
  return documentOf(path.string(), std::move(root), name.parameters, options);
}

SceneDescription readScene(const JsonDocument& document, const LoadOptions& options,
                           SceneContext& context) {
  JsonObject file{JsonValue(document)};
  file.need("whit");
  file.find("parameters");
  readCameras(file, options.instant, context.scene);
  readLights(file, options.instant, context.scene);
  readSky(file, context);
  const std::optional<double> fromSky = readAmbient(file, context.scene);
  replaceSky(context);
  MaterialReader materials(file, context);
  ItemReader(context, materials).read(file);
  materials.checkUnused();
  file.finish();
  settleInstant(options.instant, context.scene);
  finishTextures(context, fromSky);
  replaceSpheres(options.sphereSegments, context);
  return std::move(context.scene);
}

SceneDescription loadSceneFile(const fs::path& path, const SceneName& name,
                               const LoadOptions& options, Warnings& warnings, Progress* progress) {
  const JsonDocument document = documentOf(path, name, options);
  SceneContext context(path, options, warnings, progress);
  return readScene(document, options, context);
}

// Reads the settings of a model, whose lights are there, as if a scene file contained them.
std::optional<double> readModelView(const std::vector<SceneSetting>& settings,
                                    const std::string& file, SceneContext& context) {
  for (std::size_t i = 0; i < context.scene.lights.size(); ++i) {
    context.scene.lights[i].pointer = "/lights/" + std::to_string(i);
  }
  if (settings.empty()) return std::nullopt;
  JsonDocument document{file, {{"lights", describe(context.scene.lights)}}, {}};
  for (const SceneSetting& setting : settings) applySceneSetting(setting, document);
  JsonObject view{JsonValue(document)};
  context.scene.lights.clear();
  readLights(view, {}, context.scene);
  readSky(view, context);
  const std::optional<double> fromSky = readAmbient(view, context.scene);
  view.finish();
  return fromSky;
}

SceneDescription loadModelFile(const fs::path& path, const SceneName& name,
                               const LoadOptions& options, Warnings& warnings, Progress* progress) {
  if (!name.parameters.empty()) throwUsage(path.string() + " is a model: it has no parameters");
  SceneContext context(path, options, warnings, progress);
  JsonDocument nothing{path.string(), Json::object(), {}}, overrides = nothing;
  std::vector<SceneSetting> others;
  for (SceneSetting& setting : parseSettings(options)) {
    if (setting.tokens.front() == "materials") {
      applySceneSetting(setting, overrides);
    } else {
      others.push_back(std::move(setting));
    }
  }
  JsonObject noMaterials{JsonValue(nothing)}, file{JsonValue(overrides)};
  MaterialReader materials(noMaterials, context);
  ItemReader(context, materials).readModelAlone(file, path);
  supplyView(context);  // before the scene has another time than 0
  settleInstant(options.instant, context.scene);
  const bool ownAmbient = std::any_of(others.begin(), others.end(), [](const SceneSetting& s) {
    return s.tokens.front() == "ambient";
  });
  std::optional<double> fromSky = readModelView(others, path.string(), context);
  replaceSky(context);
  if (!ownAmbient && context.scene.sky.kind != Sky::Kind::none) fromSky = kAmbientOfSky;
  finishTextures(context, fromSky);
  replaceSpheres(options.sphereSegments, context);
  return std::move(context.scene);
}

}  // namespace

SceneDescription loadScene(const std::string& name, const LoadOptions& options, Warnings& warnings,
                           Progress* progress) {
  const SceneName parsed = parseSceneName(name);
  const fs::path path = findScene(parsed.file, options.shippedScenes);
  if (isModelFile(path)) return loadModelFile(path, parsed, options, warnings, progress);
  if (extensionOf(path) == ".json") return loadSceneFile(path, parsed, options, warnings, progress);
  throwUsage("\"" + parsed.file + "\": expected a scene (.json), a model (" + modelExtensions() +
             "), or the name of a shipped scene");
}

SceneDescription loadScene(const SceneText& text, const LoadOptions& options, Warnings& warnings,
                           Progress* progress) {
  const JsonDocument document = readDocument(text, options);
  SceneContext context(fs::current_path() / "scene", options, warnings, progress);
  context.scene.name = text.name;
  context.parts = &text.parts;
  return readScene(document, options, context);
}

std::optional<JsonDocument> readDocument(const std::string& name, const LoadOptions& options) {
  const SceneName parsed = parseSceneName(name);
  const fs::path path = findScene(parsed.file, options.shippedScenes);
  if (isModelFile(path)) return std::nullopt;
  return documentOf(path, parsed, options);
}

JsonDocument readDocument(const SceneText& text, const LoadOptions& options) {
  return documentOf(text.name, text.root, {}, options);
}

}  // namespace whit
