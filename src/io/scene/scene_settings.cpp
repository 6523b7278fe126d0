#include "io/scene/scene_settings.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <utility>

#include "bake/edit_scene.h"
#include "bake/finalize_steps.h"
#include "bake/scene.h"
#include "core/error.h"
#include "core/index.h"
#include "core/text.h"
#include "io/load_scene.h"
#include "io/scene/scene_sections.h"
#include "make/studio_sky.h"

namespace whit {
namespace {

// Returns the tokens of a JSON pointer; none if `text` is not a pointer, or one to the whole
// document.
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

// Returns the index of an element of `list`, or of a new element.
std::size_t indexOf(const std::string& token, const Json& list, const JsonValue& place) {
  if (token == "-") return list.size();
  std::size_t index = 0;
  const char* const end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, index);
  const bool plain = error == std::errc() && stop == end && (token[0] != '0' || token.size() == 1);
  if (!plain || index >= list.size()) {
    place.fail(concat("an index below ", list.size(), ", or - for a new element"));
  }
  return index;
}

// True if one of the members is within the other, or both are the same.
bool areRelated(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  return std::equal(a.begin(), a.begin() + std::min(a.size(), b.size()), b.begin());
}

// Returns whether the document is that of a model by itself, see describeModel().
bool isModelAlone(const JsonDocument& document) { return !document.root.contains("whit"); }

// Returns whether the section "materials" of a scene file has the material.
bool isOfFile(const Material& material, const JsonDocument& document) {
  return !isModelAlone(document) && material.pointer.starts_with("/materials/");
}

// Returns whether "view" supplies the sky, which is as bright as it suits the lights.
bool hasSuppliedSky(const JsonDocument& document) {
  return document.root.contains("view") && !document.root.contains("sky");
}

// Reads the lights. Returns false where others than before would move.
bool readEditedLights(const Scene& scene, const JsonDocument& document, SceneContext& context) {
  JsonDocument lights{document.file, {{"lights", document.root.at("lights")}}, document.parameters};
  moveLights(lights.root, -scene.origin);
  JsonObject file{JsonValue(lights)};
  readLights(file, context.instant, context.scene);
  if (context.scene.lights.size() != scene.lights.size()) return false;
  if (isModelAlone(document)) return true;  // its nodes carry its lights
  return std::ranges::equal(scene.motion.given.lights, context.scene.motion.lights, {},
                            &MovingLight::light, &MovingLight::light);
}

// Reads cameras that stand still, and the image size. The positions of cameras decide which
// instances are too small to be traced.
bool readEditedView(const Scene& scene, JsonObject& file, SceneContext& context) {
  readCameras(file, context.instant, context.scene);
  const bool moves = !scene.motion.given.cameras.empty() || !context.scene.motion.cameras.empty();
  return !moves && !context.scene.cameras.empty() && scene.instances.empty();
}

// Reads the sky and the ambient light, which is `fromSky` times the sky's if that is there. Returns
// false for ambient light that a model was supplied with, because its sky may have been another,
// and where a model's own radius of occlusion is needed, which an edit may have replaced.
bool readEditedSurroundings(const Scene& scene, const JsonDocument& document, SceneContext& context,
                            std::optional<double>& fromSky) {
  JsonObject file{JsonValue(document)};
  if (scene.isModel && !file.has("ambient")) return false;
  const bool suppliesRadius =
      isModelAlone(document) && !document.root["ambient"].contains("occlusion");
  if (suppliesRadius) return false;

  context.knownSky = scene.sky.name;
  // The studio of a model is supplied, not described by settings, and as bright as suits its
  // lights.
  const bool isSupplied =
      hasSuppliedSky(document) || (isModelAlone(document) && !document.root.contains("sky"));
  if (isSupplied && scene.sky.name == kStudio) {
    Sky& sky = context.scene.sky;
    sky.kind = Sky::Kind::image;
    sky.name = kStudio;
    sky.scale = scene.sky.scale;
  }
  readSky(file, context);
  fromSky = readAmbient(file, context.scene);
  replaceSky(context);
  context.textures.finish(context.scene);
  return true;
}

// Changes the material that the setting is about, as its reader would have. Returns false for other
// settings, and for members that triangles or textures depend on.
bool editMaterial(const SceneSetting& setting, const JsonDocument& document, const Scene& scene,
                  std::vector<Material>& materials) {
  // The pointer to the material comes before the name of the member.
  std::string pointer;
  auto before = scene.materials.end();
  auto token = setting.tokens.begin();
  for (; token != setting.tokens.end() && before == scene.materials.end(); ++token) {
    pointer += "/" + escapePointer(*token);
    before = std::ranges::find(scene.materials, pointer, &Material::pointer);
  }
  if (token == setting.tokens.end()) return false;

  Material& material = materials[before - scene.materials.begin()];
  JsonObject object(JsonValue(document, document.root.at(Json::json_pointer(pointer)), pointer));
  const auto keepMap = [&](const JsonValue& /*name*/, const auto& map) {
    return (*before).*map.field;
  };
  readMaterial(object, keepMap, material);
  object.finish();

  bool isBaked = material.castsShadow != before->castsShadow;
  forEachMember<Material>([&](const auto& member) {
    if (!member.rules.baked || *token != member.name) return;
    isBaked |=
        member.rules.kind == MemberKind::map || material.*member.field != (*before).*member.field;
  });
  if (isBaked) return false;

  // Only the readers of models leave maps out.
  if (isOfFile(material, document)) return true;
  for (const auto& [name, map] : kReplacedMaps) {
    const bool isGiven = object.has(std::string(name) + "Map");
    if (object.has(name) && !isGiven) material.*map = kNoTexture;
  }
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
      throwUsage(concat(wanted, ", of at most ", kJsonDepthLimit, " steps"));
    }
    return setting;
  }
  throwUsage(wanted);
}

// The last setting that is related to the member is removed if it sets that very member. The
// settings behind it are not related, so the new one may as well come after them.
void addSceneSetting(const std::string& text, std::vector<std::string>& settings) {
  const std::vector<std::string> tokens = parseSceneSetting(text).tokens;
  const std::string section = "/" + escapePointer(tokens.front());
  const bool appends = contains(tokens, "-");
  for (std::size_t i = settings.size(); i-- > 0 && !appends;) {
    if (!settings[i].starts_with(section)) continue;
    const std::vector<std::string> other = parseSceneSetting(settings[i]).tokens;
    if (!areRelated(tokens, other)) continue;
    if (tokens == other) settings.erase(settings.begin() + i);
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

JsonDocument describeModel(const std::string& file, const Scene& scene,
                           const LoadOptions& options) {
  JsonDocument document{file, {{"lights", describe(scene.lights)}}, {}};
  moveLights(document.root, scene.origin);
  for (const std::string& text : options.settings) {
    const SceneSetting setting = parseSceneSetting(text);
    const std::string& section = setting.tokens.front();
    if (section != "lights") applySceneSetting(setting, document);
  }
  return document;
}

bool editScene(const std::vector<SceneSetting>& touched, const LoadOptions& options,
               const JsonDocument& document, Warnings& warnings, Scene& scene) {
  bool shading = false, lights = false, view = false, surroundings = false;
  std::vector<Material> materials = scene.materials;

  // Each setting touches one part of the scene, or makes it necessary to read the scene again.
  for (const auto& [tokens, value] : touched) {
    const std::string& section = tokens.front();
    if (section == "lights") {
      // The members of a moving light can be edited in place, but its motion cannot.
      const bool isMember = tokens.size() > 2 && tokens[2] != "motion";
      if (hasSuppliedSky(document) || (scene.motion.ofLights() && !isMember)) return false;
      lights = true;
    } else if (section == "sky" || section == "ambient") {
      surroundings = true;
    } else if ((section == "cameras" || section == "size") && !scene.isModel) {
      view = true;
    } else if (editMaterial({tokens, value}, document, scene, materials)) {
      shading = true;
    } else {
      return false;
    }
  }

  for (const Material& material : materials) {
    if (!shading || !isOfFile(material, document)) continue;
    warnOfSum(material, concat(document.file, "#", material.pointer), warnings);
  }

  // All that may fail comes before the first change.
  SceneContext context(std::filesystem::absolute(document.file), options, warnings, nullptr);
  JsonObject file{JsonValue(document)};
  std::optional<double> fromSky;
  if (lights && !readEditedLights(scene, document, context)) return false;
  if (view && !readEditedView(scene, file, context)) return false;
  if (surroundings && !readEditedSurroundings(scene, document, context, fromSky)) return false;

  SceneDescription& read = context.scene;
  if (!lights) read.lights = scene.lights;

  // An image of the sky that was there before is not read again. An error gives it back.
  const bool sameImage = surroundings && !read.sky.name.empty() && read.sky.name == scene.sky.name;
  if (sameImage) std::swap(read.sky.image, scene.sky.image);
  try {
    if (fromSky) read.ambient = ambientFromSky(read.sky, *fromSky, read.ambient);
    if (surroundings) validate(scene.name, read.sky, read.ambient);
    if (shading || lights) editShading(scene, std::move(materials), std::move(read.lights));
  } catch (...) {
    if (sameImage) std::swap(read.sky.image, scene.sky.image);
    throw;
  }
  if (surroundings) editSky(scene, read.sky, read.ambient);

  // A light that moves is edited where it starts.
  for (const MovingLight& light : read.motion.lights) {
    MovingLight& moving =
        *std::ranges::find(scene.motion.given.lights, light.light, &MovingLight::light);
    moving.position = light.position;
    moving.direction = light.direction;
  }
  if (!view) return true;

  scene.cameras = std::move(read.cameras);
  scene.cameraPath = std::move(read.cameraPath);
  scene.width = read.width;
  scene.height = read.height;
  gatherEffects(scene);
  return true;
}

}  // namespace whit
