#include "io/load_scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include "core/box.h"
#include "core/error.h"
#include "core/nearest_name.h"
#include "io/json_reader.h"
#include "io/paths.h"
#include "io/read_file.h"
#include "io/scene_context.h"
#include "io/scene_items.h"
#include "io/scene_materials.h"
#include "io/scene_settings.h"
#include "io/scene_view.h"

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
    context.scene.ambient = ambientFromSky(context.scene.sky, *ambientFromSkyStrength);
  }
}

SceneDescription loadSceneFile(const fs::path& path, const SceneName& name,
                               const LoadOptions& options, Warnings& warnings, Progress* progress) {
  JsonDocument document;
  document.file = path.string();
  const std::vector<SceneSetting> settings = parseSettings(options);
  document.root = parseJson(readTextFile(path, kJsonBytesLimit), document.file);
  for (const SceneSetting& setting : settings) applySceneSetting(setting, document);
  JsonObject file{JsonValue(document)};
  file.need("whit").integer(kSchemaVersion, kSchemaVersion);
  readParameters(file, name.parameters, document);
  SceneContext context(path, options, warnings, progress);
  readCameras(file, context.scene);
  readLights(file, context.scene);
  readSky(file, context);
  const std::optional<double> fromSky = readAmbient(file, context.scene);
  MaterialReader materials(file, context);
  ItemReader(context, materials).read(file);
  materials.checkUnused();
  file.finish();
  finishTextures(context, fromSky);
  return std::move(context.scene);
}

// Of the objects' boxes where their instances stand. The description is not validated yet: points
// that are not finite count for nothing.
Box boundsOf(const SceneDescription& scene) {
  const auto add = [](const Vec3f& p, Box& box) {
    if (isFinite(p)) box.add(p);
  };
  std::vector<Box> objects(scene.objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    for (const Mesh& mesh : scene.objects[i].meshes) {
      for (const Vec3f& p : mesh.positions) add(p, objects[i]);
    }
  }
  Box all;
  for (const Instance& instance : scene.instances) {
    const Box& own = objects[instance.object];
    if (own.empty()) continue;
    for (int corner = 0; corner < 8; ++corner) {
      add(Vec3f(instance.toWorld.point(Vec3d(own.corner(corner)))), all);
    }
  }
  return all.empty() ? Box{Vec3f(), Vec3f()} : all;
}

// A light above, beside and in front of the model, and light from all around.
void supplyLight(SceneDescription& scene) {
  const auto [lower, upper] = boundsOf(scene);
  const float size = std::max(length(upper - lower), 1e-6f);
  const Vec3f offset = Vec3f(0.6f, 1.0f, 0.8f) * size;
  Light light;
  light.name = "supplied";
  light.position = (lower + upper) * 0.5f + offset;
  // A white surface that faces the light from the middle of the model is seen as 1.
  light.intensity = Rgb(3.14159265f * dot(offset, offset));
  light.radius = 0.01f * size;
  scene.lights.push_back(light);
  scene.ambient.up = Rgb(0.25f);
  scene.ambient.down = Rgb(0.1f);
}

Json listOf(const Vec3f& v) { return Json::array({v.x, v.y, v.z}); }

// A light as a scene file has it; every bit comes back.
Json describeLight(const Light& light) {
  Json json{{"name", light.name}};
  if (light.kind != Light::Kind::point) json["direction"] = listOf(light.direction);
  if (light.kind == Light::Kind::directional) {
    json.update({{"type", "directional"}, {"irradiance", listOf(light.intensity)}});
    return json;
  }
  json.update({{"position", listOf(light.position)},
               {"intensity", listOf(light.intensity)},
               {"radius", light.radius}});
  if (light.kind == Light::Kind::spot) {
    json.update({{"type", "spot"},
                 {"innerConeAngle", light.innerConeAngle},
                 {"outerConeAngle", light.outerConeAngle}});
  }
  return json;
}

Json describeLights(const std::vector<Light>& lights) {
  Json list = Json::array();
  for (const Light& light : lights) list.push_back(describeLight(light));
  return list;
}

// Of a model, whose lights are there: as if a scene file gave them with the settings.
std::optional<double> readModelView(const std::vector<SceneSetting>& settings,
                                    const std::string& file, SceneContext& context) {
  for (std::size_t i = 0; i < context.scene.lights.size(); ++i) {
    context.scene.lights[i].pointer = "/lights/" + std::to_string(i);
  }
  if (settings.empty()) return std::nullopt;
  JsonDocument document{file, {{"lights", describeLights(context.scene.lights)}}, {}};
  for (const SceneSetting& setting : settings) applySceneSetting(setting, document);
  JsonObject view{JsonValue(document)};
  context.scene.lights.clear();
  readLights(view, context.scene);
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
  if (context.scene.lights.empty()) supplyLight(context.scene);
  finishTextures(context, readModelView(others, path.string(), context));
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

}  // namespace whit
