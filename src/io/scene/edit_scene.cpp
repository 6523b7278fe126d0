// Sets members of a scene between frames.
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bake/edit_shading.h"
#include "bake/scene.h"
#include "io/load_scene.h"
#include "io/scene/scene_sections.h"
#include "io/scene/scene_settings.h"

namespace whit {

namespace {

// Sections of a document by themselves.
JsonDocument sectionsOf(const JsonDocument& document, std::initializer_list<const char*> names) {
  JsonDocument sections{document.file, Json::object(), document.parameters};
  for (const char* name : names) {
    if (document.root.contains(name)) sections.root[name] = document.root[name];
  }
  return sections;
}

bool editLights(const LoadOptions& options, const JsonDocument& sections, Scene& scene) {
  SceneDescription read;
  JsonObject file{JsonValue(sections)};
  readLights(file, options.instant, read);
  const bool moves = scene.motion.ofLights() || !read.motion.lights.empty();
  if (moves || read.lights.size() != scene.lights.size()) return false;
  editShading(scene, scene.materials, std::move(read.lights));
  return true;
}

// Edits cameras that stand still, and the image size. The positions of cameras decide which
// instances are too small to be traced.
bool editView(const LoadOptions& options, const JsonDocument& sections, Scene& scene) {
  SceneDescription read;
  JsonObject file{JsonValue(sections)};
  readCameras(file, options.instant, read);
  const bool moves = !scene.motion.given.cameras.empty() || !read.motion.cameras.empty();
  if (moves || read.cameras.empty() || !scene.instances.empty()) return false;
  scene.cameras = std::move(read.cameras);
  scene.cameraPath = std::move(read.cameraPath);
  scene.width = read.width;
  scene.height = read.height;
  gatherEffects(scene);
  return true;
}

bool editSurroundings(const LoadOptions& options, const JsonDocument& sections, Scene& scene) {
  const auto given = sections.root.find("sky");
  const bool namesImage =
      given != sections.root.end() && given->is_object() && given->contains("image");
  if (!options.sky.empty() || scene.sky.kind == Sky::Kind::image || namesImage) return false;
  Warnings none;
  SceneContext context("scene", options, none, nullptr);
  JsonObject file{JsonValue(sections)};
  readSky(file, context);
  const std::optional<double> fromSky = readAmbient(file, context.scene);
  Sky& sky = context.scene.sky;
  if (sky.kind == Sky::Kind::image) return false;
  const Ambient& ambient = context.scene.ambient;
  editSky(scene, sky, fromSky ? ambientFromSky(sky, *fromSky, ambient) : ambient);
  return true;
}

bool isBakedIn(std::string_view name) {
  bool baked = false;
  forEachMember<Material>(
      [&](const auto& member) { baked = baked || (member.rules.baked && member.name == name); });
  return baked;
}

bool editMaterial(const SceneSetting& setting, const LoadOptions& options,
                  const JsonDocument& document, JsonDocument& sections, Scene& scene) {
  if (setting.tokens.size() < 3 || isBakedIn(setting.tokens[2])) return false;
  const std::string& name = setting.tokens[1];
  const std::string pointer = "/materials/" + escapePointer(name);
  const auto known = std::find_if(scene.materials.begin(), scene.materials.end(),
                                  [&](const Material& m) { return m.pointer == pointer; });
  const auto all = document.root.find("materials");
  if (known == scene.materials.end() || all == document.root.end() || !all->contains(name)) {
    return false;
  }
  sections.root["materials"] = Json::object({{name, (*all)[name]}});
  applySceneSetting(setting, sections);
  JsonDocument plain = sections;
  Json& members = plain.root["materials"][name];
  forEachMap([&](const auto& member) { members.erase(member.name); });
  Warnings none;
  SceneContext context("scene", options, none, nullptr);
  JsonObject file{JsonValue(plain)};
  MaterialReader reader(file, context);
  Material& read = context.scene.materials.front();
  if (read.castsShadow != known->castsShadow) return false;
  std::vector<Material> materials = scene.materials;
  materials[static_cast<std::size_t>(known - scene.materials.begin())] = std::move(read);
  editShading(scene, std::move(materials), scene.lights);
  return true;
}

bool editSections(const SceneSetting& setting, const LoadOptions& options,
                  const JsonDocument& document, JsonDocument& sections, Scene& scene) {
  const std::string& section = setting.tokens.front();
  if (section == "materials") return editMaterial(setting, options, document, sections, scene);
  if (section == "lights") {
    sections = sectionsOf(document, {"lights"});
  } else if (section == "cameras" || section == "size") {
    sections = sectionsOf(document, {"cameras", "size", "path"});
  } else if (section == "sky" || section == "ambient") {
    sections = sectionsOf(document, {"sky", "ambient"});
  } else {
    return false;
  }
  applySceneSetting(setting, sections);
  if (section == "lights") return editLights(options, sections, scene);
  if (section == "sky" || section == "ambient") return editSurroundings(options, sections, scene);
  return editView(options, sections, scene);
}

}  // namespace

bool editScene(const SceneSetting& setting, const LoadOptions& options, JsonDocument* document,
               Scene& scene) {
  if (!document) {
    if (setting.tokens.front() != "lights" || scene.motion.ofLights()) return false;
    JsonDocument lights{scene.name, {{"lights", describe(scene.lights)}}, {}};
    applySceneSetting(setting, lights);
    return editLights(options, lights, scene);
  }
  JsonDocument sections{document->file, Json::object(), document->parameters};
  if (!editSections(setting, options, *document, sections, scene)) return false;
  if (setting.tokens.front() == "materials") {
    document->root["materials"][setting.tokens[1]] =
        std::move(sections.root["materials"][setting.tokens[1]]);
  } else {
    document->root.update(sections.root);
  }
  return true;
}

}  // namespace whit
