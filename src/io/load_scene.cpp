#include "io/load_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "core/index.h"
#include "core/text.h"
#include "io/files.h"
#include "io/scene/scene_sections.h"
#include "io/scene/scene_settings.h"
#include "make/ground_shadow.h"
#include "make/light_level.h"
#include "make/model_view.h"
#include "make/shape.h"
#include "make/studio_sky.h"
#include "scene/generation_limit.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

constexpr int kSchemaVersion = 1;

// The usual level of the supplied light, which the studio's brightness suits.
constexpr double kUsualLevel = 0.5;
// The radius of ambient occlusion, in radii of the model.
constexpr float kOcclusion = 0.3f;
constexpr double kDimmest = 1.0e-6, kBrightest = 1.0e6;
// The color behind models, lighter than most of them and darker than white ones.
constexpr const char* kModelBackground = "c8c8c8";

// Returns a light under which white surfaces that face it from `distance` have the radiance
// `level`.
Light supplied(const char* name, const Vec3f& position, float distance, float level, float size) {
  Light light;
  light.name = name;
  light.position = position;
  light.intensity = Rgb(level * 3.14159265f * distance * distance);
  light.radius = 0.01f * size;
  return light;
}

// Adds a light above, beside and in front of the model, and a weak one from the other side: without
// it rough metals would be black there, because only diffuse surfaces reflect ambient light. A room
// gets one lamp below its ceiling instead, as bright about half across the room as the first light.
void supplyLights(const ModelView& view, SceneDescription& scene) {
  constexpr float kFill = 0.25f, kAcross = 0.4f;
  constexpr float kLeastSize = 1e-15f;  // so that the square of the lights' radius is a number
  const float size = std::max(static_cast<float>(2 * view.radius), kLeastSize);
  const Vec3f center(view.center);
  const Vec3f key = Vec3f(0.6f, 1.0f, 0.8f) * size, fill = Vec3f(-1.0f, -0.2f, 0.9f) * size;

  if (view.inside) {
    scene.lights = {supplied("supplied", Vec3f(view.ceiling), kAcross * size, 1, size)};
  } else {
    scene.lights = {supplied("supplied", center + key, length(key), 1, size),
                    supplied("supplied fill", center + fill, length(fill), kFill, size)};
  }

  scene.ambient.up = Rgb(0.25f);
  scene.ambient.down = Rgb(0.1f);
}

// Members of a scene that concern the view of a model.
constexpr std::array<const char*, 4> kViewMembers{"viewpoint", "azimuth", "zoom", "ground"};

// Reads what is asked of a supplied camera.
void readViewMembers(JsonObject& members, SceneDescription& scene) {
  constexpr double kWholeTurn = 360, kLargestZoom = 100;
  if (const JsonValue view = members.find("viewpoint")) {
    const bool isInside = view.word({"outside", "inside"}) == "inside";
    scene.viewpoint = isInside ? Viewpoint::inside : Viewpoint::outside;
  }
  if (const JsonValue azimuth = members.find("azimuth")) {
    scene.azimuth = azimuth.number(-kWholeTurn, kWholeTurn);
  }
  if (const JsonValue zoom = members.find("zoom")) {
    scene.zoom = zoom.number(1 / kLargestZoom, kLargestZoom);
  }
}

// Returns the time of the last key of all that plays: one animation of each model, and what the
// scene file moves itself. Returns nothing if nothing plays.
std::optional<double> endOfAnimations(const SceneContext& context) {
  std::optional<double> end;
  const auto playFirst = [&](const std::vector<Animation>& all, const std::string& name) {
    const auto isPlayed = [&](const Animation& a) { return name.empty() || a.name == name; };
    const auto played = std::ranges::find_if(all, isPlayed);
    if (played != all.end()) end = std::max(end.value_or(0), played->seconds);
  };

  for (const auto& [path, model] : context.models) {
    playFirst(model->animations(), context.instant.animation);
  }
  playFirst(context.scene.animations, kSceneMotion);
  return end;
}

// Returns the view for a supplied camera, which has to see all that plays.
ModelView viewOfAnimation(const SceneContext& context) {
  const SceneDescription& scene = context.scene;
  const bool supplies = scene.cameras.empty() || scene.asksForView();
  if (!supplies || !context.instant.moves()) return viewOf(scene);

  const std::optional<double> end = endOfAnimations(context);
  if (!end) return viewOf(scene);
  return viewOf(scene, *end);
}

// Puts the camera before the others, which keep their nodes.
void addFirstCamera(Camera camera, SceneDescription& scene) {
  const auto taken = [&](const Camera& other) { return other.name == camera.name; };
  if (std::ranges::any_of(scene.cameras, taken)) camera.name += " of the scene";
  scene.cameras.insert(scene.cameras.begin(), std::move(camera));
  for (MovingCamera& moving : scene.motion.cameras) ++moving.camera;
}

// Makes the view of the model the first camera if the file has no camera, if another side was asked
// for, or if the file's first camera sees nothing.
void supplyCamera(const ModelView& view, SceneContext& context) {
  SceneDescription& scene = context.scene;
  if (!(view.radius > 0)) return;

  if (!scene.asksForView() && !scene.cameras.empty()) {
    const Camera& first = scene.cameras.front();
    if (context.instant.moves() || seesSomething(scene, first)) return;
    context.warnings.note(
        "camera that sees nothing: by default the model is shown instead "
        "(--camera NAME chooses a camera of the file)",
        scene.name + ": " + first.name);
  }

  if (scene.viewpoint == Viewpoint::automatic && view.inside) {
    context.warnings.note(
        "model taken for a room is seen from inside (--viewpoint outside shows it "
        "from outside)",
        scene.name);
  }

  addFirstCamera(view.camera, scene);
}

// Completes a model whose own lights and cameras have been read. The sky is the studio, as bright
// as suits the lights, unless there is a sky already, or another one or none was asked for. A
// supplied camera, and supplied lights, suit all of the animation that is played.
void supplyView(JsonObject& members, SceneContext& context) {
  SceneDescription& scene = context.scene;
  readViewMembers(members, scene);
  const ModelView view = viewOfAnimation(context);

  scene.isModel = true;
  scene.options.emplace("exposure", "auto");
  scene.options.emplace("tonemap", "filmic");
  scene.options.emplace("terminator", "on");
  scene.ambient.occlusion = kOcclusion * static_cast<float>(view.radius);

  const bool asksForStudio = context.sky.empty() || context.sky == kStudio;
  const bool suppliesSky = asksForStudio && scene.sky.kind == Sky::Kind::none;
  if (suppliesSky) scene.sky = studioSky();
  if (scene.lights.empty()) {
    supplyLights(view, scene);
  } else if (const double level = lightLevel(scene); level > 0 && suppliesSky) {
    scene.sky.scale = static_cast<float>(std::clamp(level / kUsualLevel, kDimmest, kBrightest));
  }

  supplyCamera(view, context);
  context.hasGround = members.find("ground").flagOr(false) && !view.inside;
}

// Reads the member "view" of a scene file: "model" completes the scene as if it were a model.
void readView(JsonObject& file, std::optional<double>& fromSky, SceneContext& context) {
  const JsonValue view = file.find("view");
  if (!view) {
    for (const char* member : kViewMembers) {
      if (!file.has(member)) continue;
      throwUsage(std::string(member) + ": " + context.scene.name +
                 " is neither a model nor a scene file with \"view\": \"model\"");
    }
    return;
  }
  view.word({"model"});

  const Ambient own = context.scene.ambient;
  // A studio that --sky names is supplied like the one that is there without it.
  if (context.sky == kStudio && !file.has("sky")) context.scene.sky = Sky();
  supplyView(file, context);
  if (file.has("ambient")) {
    context.scene.ambient = own;
  } else if (context.scene.sky.kind != Sky::Kind::none) {
    fromSky = kAmbientOfSky;
  }
}

void readFog(JsonObject& file, SceneDescription& scene) {
  const JsonValue value = file.find("fog");
  if (!value) return;
  JsonObject object(value);
  readMembers(object, scene.fog);
  object.finish();
}

enum class Sections { these, others };

// Applies the settings of these sections, or of all others.
void applySettings(const LoadOptions& options, Sections which,
                   const std::vector<std::string>& sections, JsonDocument& document) {
  for (const std::string& text : options.settings) {
    const SceneSetting setting = parseSceneSetting(text);
    const bool isListed = contains(sections, setting.tokens.front());
    if (isListed == (which == Sections::these)) applySceneSetting(setting, document);
  }
}

// Reads the cameras of a model again if settings change or add one. They then stand still where the
// file has them, because the nodes of an animation know nothing of the changes.
void readCameraSettings(const LoadOptions& options, JsonDocument document,
                        SceneDescription& scene) {
  Json& cameras = document.root["cameras"];
  for (const Camera& camera : scene.cameras) {
    movePoints(cameras[camera.name] = describe(camera), scene.origin);
  }
  const Json own = document.root;
  applySettings(options, Sections::these, {"cameras"}, document);
  if (document.root == own) return;

  for (Json& camera : cameras) movePoints(camera, -scene.origin);
  scene.cameras.clear();
  scene.motion.cameras.clear();
  JsonObject file{JsonValue(document)};
  readCameras(file, {}, scene);
}

// Reads the values of parameters: the scene's own ones, and then those given with its name.
void readParameters(JsonObject& file, const std::map<std::string, double>& given,
                    JsonDocument& document) {
  std::vector<std::string> names;
  std::map<std::string, double> values;  // apart: parameters do not refer to each other
  for (const auto& [name, value] : file.find("parameters").members()) {
    values[name] = value.number();
    names.push_back(name);
  }
  document.parameters = std::move(values);

  for (const auto& [name, value] : given) {
    const auto known = document.parameters.find(name);
    if (known == document.parameters.end()) {
      throwUsage(document.file + " has no parameter '" + name + "'" + didYouMean(name, names));
    }
    if (!(std::abs(value) <= kLargestNumber)) {
      throwUsage("parameter \"" + name + "\" is beyond what a scene can hold");
    }
    known->second = value;
  }
}

// Adds a camera that flies the path before all others.
void addPathCamera(SceneDescription& scene) {
  Camera camera = scene.cameraPath.front().camera;
  camera.name = "path";
  addFirstCamera(camera, scene);
  scene.motion.cameras.push_back({0, kNoNode, scene.cameras.front()});
}

bool hasNode(const Rig& rig, const std::string& name) {
  return std::ranges::any_of(rig,
                             [&](const RigNode& n) { return !n.name.empty() && n.name == name; });
}

void requireMovable(const std::string& pointer, const SceneDescription& scene) {
  if (hasNode(scene.motion.rig, pointer)) return;
  for (const Object& object : scene.objects) {
    for (const Mesh& mesh : object.meshes) {
      if (!mesh.deformation || !mesh.deformation->hasSkin()) continue;
      if (hasNode(*mesh.deformation->skeleton, pointer)) return;
    }
  }
  throwUsage(
      "\"" + pointer + "\" is not in " + scene.name +
      ", or cannot be moved: only items, cameras and lights of scene files can, and nodes of "
      "glTF models that hold something");
}

// Sets the time at which the scene is looked at. Throws if the animation or an item that is to be
// moved does not exist, or if nothing moves.
void applyInstant(const Instant& instant, SceneDescription& scene) {
  const std::vector<std::string> names = namesIn(scene.animations);
  if (!instant.animation.empty() && !contains(names, instant.animation)) {
    throwUsage(scene.name + " has no animation '" + instant.animation + "'" +
               didYouMean(instant.animation, names));
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
    throwUsage(concat("--sphere-segments expected 0 or at least ", kLeast, ", found ", segments));
  }
  const GenerationLimit limit(context.budget.left());
  for (Object& object : context.scene.objects) {
    for (Mesh& mesh : object.meshes) procedural::tessellateSpheres(mesh, segments);
  }
}

// `fromSky` is the strength of ambient light that depends on the sky's image.
SceneDescription finish(const LoadOptions& options, std::optional<double> fromSky,
                        SceneContext& context) {
  SceneDescription& scene = context.scene;
  context.textures.finish(scene);
  if (fromSky) scene.ambient = ambientFromSky(scene.sky, *fromSky, scene.ambient);

  // The studio is there for light and reflections. The background of models has one tone, however
  // the picture is exposed.
  const bool isInStudio = scene.sky.kind == Sky::Kind::image && scene.sky.name == kStudio;
  if (scene.isModel && isInStudio) scene.options.emplace("background", kModelBackground);

  replaceSpheres(options.sphereSegments, context);
  if (context.hasGround) addGroundShadow(scene);
  return std::move(scene);
}

// Returns the document with the settings and parameters in their places.
JsonDocument documentOf(const std::string& name, Json root,
                        const std::map<std::string, double>& parameters,
                        const LoadOptions& options) {
  JsonDocument document{name, std::move(root), {}};
  applySettings(options, Sections::others, {}, document);
  JsonObject file{JsonValue(document)};
  file.need("whit").integer(kSchemaVersion, kSchemaVersion);
  readParameters(file, parameters, document);
  return document;
}

JsonDocument documentOf(const fs::path& path, const SceneName& name, const LoadOptions& options) {
  Json root = parseJson(readTextFile(path, kJsonBytesLimit), path.string());
  return documentOf(path.string(), std::move(root), name.parameters, options);
}

// Takes over the size of the picture that is asked for, which supplied cameras fit.
void takeSize(const LoadOptions& options, SceneDescription& scene) {
  if (!options.size) return;
  scene.width = options.size->width;
  scene.height = options.size->height;
}

// Reads the light around a scene, and its options. Returns the strength of ambient light that
// depends on the sky's image.
std::optional<double> readSurroundings(JsonObject& file, SceneContext& context) {
  readOptions(file, context.scene);
  readSky(file, context);
  const std::optional<double> fromSky = readAmbient(file, context.scene);
  readFog(file, context.scene);
  replaceSky(context);
  return fromSky;
}

// Reads the lights of a model again with the settings, as if a scene file contained them.
void readLightSettings(const LoadOptions& options, JsonDocument& document, JsonObject& file,
                       SceneDescription& scene) {
  for (const auto i : indices(scene.lights)) {
    scene.lights[i].pointer = concat("/lights/", i);
  }
  if (options.settings.empty()) return;

  document.root["lights"] = describe(scene.lights);
  moveLights(document.root, scene.origin);
  applySettings(options, Sections::these, {"lights"}, document);
  moveLights(document.root, -scene.origin);

  scene.lights.clear();
  readLights(file, {}, scene);
}

// A camera may state a fov that it does not use, so that --set changes its projection alone.
void noteUnusedFovs(JsonObject& file, SceneContext& context) {
  const auto cameras = file.find("cameras").members();
  for (const auto i : indices(cameras)) {
    const JsonValue fov = cameras[i].second["fov"];
    if (!fov || seesByFov(context.scene.cameras[i])) continue;
    context.warnings.note(
        "fov of a camera with k, orthographicHeight or another projection does nothing",
        fov.where());
  }
}

// Throws if the camera that is asked for cannot exist. Models and views have more cameras than
// those of the file, and the camera "path" flies the scene's path.
void requireCamera(const std::string& camera, JsonObject& file, const SceneDescription& scene) {
  const std::vector<std::string> names = namesIn(scene.cameras);
  const bool areAll = !names.empty() && !file.has("view") && camera != "path";
  if (areAll && !contains(names, camera)) indicesOf(camera, names, "camera");
}

SceneDescription readScene(const JsonDocument& document, const LoadOptions& options,
                           SceneContext& context) {
  JsonObject file{JsonValue(document)};
  file.need("whit");
  file.find("parameters");

  readCameras(file, options.instant, context.scene);
  noteUnusedFovs(file, context);
  requireCamera(options.camera, file, context.scene);
  if (context.scene.cameras.empty()) takeSize(options, context.scene);

  readLights(file, options.instant, context.scene);
  std::optional<double> fromSky = readSurroundings(file, context);

  MaterialReader materials(file, context);
  readItems(file, context, materials);
  materials.checkUnused();
  if (const JsonValue variant = JsonValue(document)["variant"]) {
    throwBadScene(variant.where(),
                  "variants are those of glTF files: a scene states one in the item of the model, "
                  "as {\"model\": \"shoe.glb\", \"variant\": \"NAME\"}");
  }

  // The camera of a model may have set a size of its own.
  if (file.has("view")) takeSize(options, context.scene);
  readView(file, fromSky, context);
  file.finish();

  applyInstant(options.instant, context.scene);
  return finish(options, fromSky, context);
}

SceneDescription loadModelFile(const fs::path& path, const SceneName& name,
                               const LoadOptions& options, Warnings& warnings, Progress* progress) {
  if (!name.parameters.empty()) throwUsage(path.string() + " is a model: it has no parameters");
  SceneContext context(path, options, warnings, progress);
  SceneDescription& scene = context.scene;

  // The settings stand for a scene file. Those of lights and cameras change the model's own, which
  // have to be read first.
  const JsonDocument nothing{path.string(), Json::object(), {}};
  JsonDocument document = nothing;
  applySettings(options, Sections::others, {"lights", "cameras"}, document);
  JsonObject noMaterials{JsonValue(nothing)}, file{JsonValue(document)};
  MaterialReader materials(noMaterials, context);
  readModelAlone(file, path, context, materials);

  // A supplied view is that of the model at 0 s.
  takeSize(options, scene);
  supplyView(file, context);
  readCameraSettings(options, nothing, scene);
  file.find("cameras");
  applyInstant(options.instant, scene);

  readLightSettings(options, document, file, scene);
  std::optional<double> fromSky = readSurroundings(file, context);
  const bool ownAmbient = file.has("ambient");
  file.finish();
  if (!ownAmbient && scene.sky.kind != Sky::Kind::none) fromSky = kAmbientOfSky;
  return finish(options, fromSky, context);
}

}  // namespace

SceneDescription loadScene(const std::string& name, const LoadOptions& options, Warnings& warnings,
                           Progress* progress) {
  const SceneName parsed = parseSceneName(name);
  const fs::path path = findScene(parsed.file, options.shippedScenes);
  if (isModelFile(path)) return loadModelFile(path, parsed, options, warnings, progress);
  if (extensionOf(path) != ".json") {
    throwUsage("\"" + parsed.file + "\": expected a scene (.json), a model (" + modelExtensions() +
               "), or the name of a shipped scene");
  }
  const JsonDocument document = documentOf(path, parsed, options);
  SceneContext context(path, options, warnings, progress);
  return readScene(document, options, context);
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

Scene finalizeScene(const std::string& file, SceneDescription description, Warnings& warnings,
                    Progress* progress) {
  try {
    return Scene::finalize(std::move(description), warnings, progress);
  } catch (const Error& error) {
    if (error.status() != ExitStatus::badScene) throw;
    throw Error(error.status(), file + ": " + error.what(),
                {file, error.place().place, error.place().expected});
  }
}

}  // namespace whit
