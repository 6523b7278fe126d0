#include "io/scene/scene_settings.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

#include "bake/edit_scene.h"
#include "bake/scene.h"
#include "core/error.h"
#include "io/load_scene.h"
#include "io/scene/scene_sections.h"

namespace whit {
namespace {

// Empty unless `text` is a pointer to something inside.
std::vector<std::string> tokensOf(const std::string& text) {
  std::vector<std::string> tokens;
  try {
    for (Json::json_pointer rest(text); !rest.empty(); rest.pop_back()) {
      tokens.push_back(rest.back());
    }
  } catch (const Json::parse_error&) {
    return {};
  }
  std::ranges::reverse(tokens);
  return tokens;
}

// The index of an element of `list`, or of a new element.
std::size_t indexOf(const std::string& token, const Json& list, const JsonValue& place) {
  if (token == "-") return list.size();
  std::size_t index = 0;
  const char* const end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, index);
  const bool plain = error == std::errc() && stop == end && (token[0] != '0' || token.size() == 1);
  if (!plain || index >= list.size()) {
    place.fail("an index below " + std::to_string(list.size()) + ", or - for a new element");
  }
  return index;
}

// True if one of the members is within the other, or both are the same.
bool areRelated(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  return std::equal(
      a.begin(), a.begin() + static_cast<std::ptrdiff_t>(std::min(a.size(), b.size())), b.begin());
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
  if (!options.sky.empty() || scene.sky.kind == Sky::Kind::image) return false;
  Warnings none;
  SceneContext context("scene", options, none, nullptr);
  JsonObject file{JsonValue(sections)};
  const JsonValue given = file.find("sky");
  if (given.isObject() && given["image"]) return false;
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

bool editMaterial(const SceneSetting& setting, const LoadOptions& options, JsonDocument& sections,
                  Scene& scene) {
  const std::string& name = setting.tokens[1];
  const std::string pointer = "/materials/" + escapePointer(name);
  const auto known = std::ranges::find(scene.materials, pointer, &Material::pointer);
  if (known == scene.materials.end()) return false;
  Json members = std::move(sections.root["materials"][name]);
  forEachMap([&](const auto& member) { members.erase(member.name); });
  sections.root["materials"] = {{name, std::move(members)}};
  Warnings none;
  SceneContext context("scene", options, none, nullptr);
  JsonObject file{JsonValue(sections)};
  MaterialReader reader(file, context);
  Material& read = context.scene.materials.front();
  if (read.castsShadow != known->castsShadow) return false;
  std::vector<Material> materials = scene.materials;
  materials[static_cast<std::size_t>(known - scene.materials.begin())] = std::move(read);
  editShading(scene, std::move(materials), scene.lights);
  return true;
}

}  // namespace

SceneSetting parseSceneSetting(const std::string& text) {
  const std::string wanted =
      "'--set " + text + "': expected POINTER=VALUE, a JSON pointer into the scene and a value, " +
      "as in /lights/0/intensity=40 or '/sky/image=\"a.hdr\"'";
  for (std::size_t sign = text.find('='); sign != std::string::npos;
       sign = text.find('=', sign + 1)) {
    const std::string pointer = text.substr(0, sign), value = text.substr(sign + 1);
    if (!Json::accept(value)) continue;
    SceneSetting setting{tokensOf(pointer), parseJson(value, "--set " + pointer)};
    if (setting.tokens.empty()) throwUsage(wanted);
    if (setting.tokens.size() > kJsonDepthLimit) {
      throwUsage(wanted + ", of at most " + std::to_string(kJsonDepthLimit) + " steps");
    }
    return setting;
  }
  throwUsage(wanted);
}

// The last of those that have to do with the member can go if it is of that very member: the ones
// after it could as well come before it.
void addSceneSetting(const std::string& text, std::vector<std::string>& settings) {
  const std::vector<std::string> tokens = parseSceneSetting(text).tokens;
  const std::string section = "/" + escapePointer(tokens.front());
  const bool appends = std::ranges::find(tokens, "-") != tokens.end();
  for (std::size_t i = settings.size(); i-- > 0 && !appends;) {
    if (!settings[i].starts_with(section)) continue;
    const std::vector<std::string> other = parseSceneSetting(settings[i]).tokens;
    if (!areRelated(tokens, other)) continue;
    if (tokens == other) settings.erase(settings.begin() + static_cast<std::ptrdiff_t>(i));
    break;
  }
  settings.push_back(text);
}

void applySceneSetting(const SceneSetting& setting, JsonDocument& document) {
  Json* at = &document.root;
  std::string pointer;
  for (const std::string& token : setting.tokens) {
    if (at->is_null()) *at = Json::object();  // made by the step before
    const std::string parent = std::exchange(pointer, pointer + "/" + escapePointer(token));
    if (at->is_object()) {
      at = &(*at)[token];
    } else if (at->is_array()) {
      const std::size_t index = indexOf(token, *at, JsonValue(document, *at, pointer));
      if (index == at->size()) at->push_back(nullptr);
      at = &(*at)[index];
    } else {
      JsonValue(document, *at, parent).fail("an object or a list");
    }
  }
  *at = setting.value;
}

bool editScene(const SceneSetting& setting, const LoadOptions& options, JsonDocument* document,
               Scene& scene) {
  const std::string& section = setting.tokens.front();
  JsonDocument lights{scene.name, {{"lights", describe(scene.lights)}}, {}};
  const JsonDocument& from = document ? *document : lights;
  // The lights of a model that was moved are read with it.
  const bool isMoved = scene.origin != Vec3d();
  if (!document && (section != "lights" || isMoved)) return false;
  // What "view" supplies depends on the other sections.
  if (document && document->root.contains("view")) return false;
  JsonDocument sections{from.file, Json::object(), from.parameters};
  for (const auto& [name, value] : from.root.items()) {
    if (name != "objects" && name != "scene") sections.root[name] = value;
  }
  applySceneSetting(setting, sections);
  bool done = false;
  if (section == "lights") done = editLights(options, sections, scene);
  if (section == "cameras" || section == "size") done = editView(options, sections, scene);
  if (section == "sky" || section == "ambient") done = editSurroundings(options, sections, scene);
  if (section == "materials" && setting.tokens.size() > 2 && !isBakedIn(setting.tokens[2]) &&
      from.root.contains(Json::json_pointer{} / section / setting.tokens[1])) {
    done = editMaterial(setting, options, sections, scene);
  }
  if (done && document) applySceneSetting(setting, *document);
  return done;
}

}  // namespace whit
