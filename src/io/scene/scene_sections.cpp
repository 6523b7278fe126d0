#include "io/scene/scene_sections.h"

#include <algorithm>
#include <cstdlib>

#include "core/error.h"
#include "core/option_table.h"
#include "core/option_values.h"
#include "io/paths.h"
#include "make/studio_sky.h"

namespace whit {
namespace {

// Reads the motion of a camera or light: calls carry(map) with its place at the start, and where
// the scene moves, add(node) with the node of the rig that carries it.
template <typename Carry, typename Add>
void readMover(JsonObject& object, const Instant& instant, SceneDescription& scene,
               const Carry& carry, const Add& add) {
  const std::shared_ptr<const Motion> motion = readMotion(object, instant, scene);
  if (!motion) return;
  if (instant.moves()) {
    add(static_cast<std::uint32_t>(scene.motion.rig.size()));
    scene.motion.rig.push_back({kNoNode, Affine(), motion, movableName(object, instant)});
  }
  carry(motion->at(0));
}

void readPath(JsonObject& file, SceneDescription& scene) {
  Camera camera = scene.cameras.empty() ? Camera() : scene.cameras.front();
  for (const JsonValue& value : file.find("path").elements()) {
    JsonObject object(value);
    Keyframe frame;
    frame.time = static_cast<float>(object.need("time").number());
    if (!scene.cameraPath.empty() && !(frame.time > scene.cameraPath.back().time)) {
      object.need("time").fail("a time after that of the keyframe before");
    }
    readCamera(object, camera);
    object.finish();
    frame.camera = camera;
    frame.camera.name = "path";
    scene.cameraPath.push_back(frame);
  }
}

void readLight(JsonObject& object, Light& light) {
  readMembers(object, light);
  if (light.kind != Light::Kind::point && !(maxComponent(abs(light.direction)) > 0)) {
    object.need("direction").fail("a direction that is not [0, 0, 0]");
  }
  if (light.kind == Light::Kind::spot && !(light.innerConeAngle < light.outerConeAngle)) {
    object.value().fail("an innerConeAngle below the outerConeAngle, " +
                        std::to_string(light.outerConeAngle) + " degrees");
  }
}

template <typename Noun>
Json describeMembers(const Noun& noun) {
  Json json;
  forEachMemberInFiles(
      noun, [&](const auto& member) { json[member.name] = describe(noun.*member.field); });
  return json;
}

bool leavesFolder(const std::filesystem::path& path) { return *path.begin() == ".."; }

std::filesystem::path absolutePath(const std::filesystem::path& path) {
  return std::filesystem::weakly_canonical(std::filesystem::current_path() / path);
}

}  // namespace

void readCamera(JsonObject& object, Camera& camera) {
  readMembers(object, camera);
  const Vec3d forward = Vec3d(camera.at) - Vec3d(camera.eye);
  if (forward == Vec3d()) object.value().fail("eye and at to differ");
  const Vec3d right = cross(normalized(forward), normalized(Vec3d(camera.up)));
  constexpr double kLeastSine = 1e-6;
  if (!(length(right) > kLeastSine)) object.value().fail("an up that is not along the view");
}

void readCameras(JsonObject& file, const Instant& instant, SceneDescription& scene) {
  if (const JsonValue size = file.find("size")) {
    const auto sides = size.elements(2, "[width, height]");
    scene.width = sides[0].integer(1, kImageSideLimit);
    scene.height = sides[1].integer(1, kImageSideLimit);
  }
  for (const auto& [name, value] : file.find("cameras").members()) {
    JsonObject object(value);
    object.need("eye");
    object.need("at");
    Camera camera;
    camera.name = name;
    readCamera(object, camera);
    const auto index = static_cast<std::uint32_t>(scene.cameras.size());
    readMover(
        object, instant, scene, [&, own = camera](const Affine& map) { carry(own, map, camera); },
        [&](std::uint32_t node) {
          scene.motion.cameras.push_back({index, node, camera});
        });
    object.finish();
    scene.cameras.push_back(camera);
  }
  readPath(file, scene);
}

void readOptions(JsonObject& file, SceneDescription& scene) {
  const std::vector<std::string> names = sceneOptionNames();
  RenderOptions checked;
  for (const auto& [name, value] : file.find("options").members()) {
    if (std::ranges::find(names, name) == names.end()) {
      throwBadScene(value.where(), "expected an option of the picture" + isMeant(name, names) +
                                       ", found \"" + excerpt(name) + "\"");
    }
    if (value.isObject() || value.isArray() || value.isNull()) {
      value.fail("a number, a word, true or false");
    }
    const std::string text = value.isNumber() ? shortest(value.number())
                             : value.isText() ? value.text()
                             : value.flag()   ? "on"
                                              : "off";
    try {
      setOption(checked, name, text);
    } catch (const Error& error) {
      const std::string what = error.what(), prefix = "--" + name + ": ";
      throwBadScene(value.where(), what.substr(what.starts_with(prefix) ? prefix.size() : 0));
    }
    scene.options[name] = text;
  }
}

void readLights(JsonObject& file, const Instant& instant, SceneDescription& scene) {
  for (const JsonValue& value : file.find("lights").elements()) {
    JsonObject object(value);
    Light light;
    light.name = object.find("name").textOr("light " + std::to_string(scene.lights.size() + 1));
    light.pointer = value.pointer();
    readLight(object, light);
    MovingLight moving{static_cast<std::uint32_t>(scene.lights.size()), kNoNode, light.position,
                       light.direction};
    readMover(
        object, instant, scene, [&](const Affine& map) { carry(moving, map, light); },
        [&](std::uint32_t node) {
          moving.node = node;
          scene.motion.lights.push_back(moving);
        });
    object.finish();
    scene.lights.push_back(light);
  }
}

void readSky(JsonObject& file, SceneContext& context) {
  const JsonValue value = file.find("sky");
  if (!value) return;
  JsonObject object(value);
  Sky& sky = context.scene.sky;
  sky = Sky();
  sky.scale = object.number("scale", sky.scale, 0);
  if (const JsonValue image = object.find("image")) {
    sky.kind = Sky::Kind::image;
    sky.rotation = object.number("rotation", sky.rotation);
    const auto path = context.rules.resolve(image.text(), context.folder, image.where());
    sky.name = path.filename().string();
    if (context.sky.empty()) {
      context.textures.addEnvironment(path.string(), image.where(), sky.image);
    }
  } else if (const JsonValue preset = object.find("preset")) {
    preset.word({kStudio});
    const float scale = sky.scale;
    sky = studioSky();
    sky.scale = scale;
    sky.rotation = object.number("rotation", sky.rotation);
  } else if (const JsonValue color = object.find("color")) {
    sky.kind = Sky::Kind::color;
    sky.zenith = sky.horizon = sky.ground = color.color();
  } else if (const JsonValue zenith = object.find("zenith")) {
    sky.kind = Sky::Kind::gradient;
    sky.zenith = zenith.color();
    sky.horizon = object.need("horizon").color();
    sky.ground = object.need("ground").color();
  } else {
    object.finish();
    value.fail(
        "a sky with \"color\", with \"zenith\", \"horizon\" and \"ground\", with \"image\" or with "
        "\"preset\"");
  }
  object.finish();
}

// The ambient light's share of the sky says how open the scene is.
float usualReflection(std::optional<double> fromSky) {
  return static_cast<float>(std::min(fromSky.value_or(1), 1.0));
}

std::optional<double> readAmbient(JsonObject& file, SceneDescription& scene) {
  const JsonValue value = file.find("ambient");
  if (!value) return std::nullopt;
  JsonObject object(value);
  scene.ambient.occlusion = object.number("occlusion", scene.ambient.occlusion, 0);
  std::optional<double> fromSky;
  if (const JsonValue strength = object.find("fromSky")) {
    fromSky = strength.number(0);
    if (scene.sky.kind == Sky::Kind::none) strength.fail("a scene with a sky");
  } else if (const JsonValue color = object.find("color")) {
    scene.ambient.up = scene.ambient.down = color.color();
  } else if (const JsonValue up = object.find("up")) {
    scene.ambient.up = up.color();
    scene.ambient.down = object.need("down").color();
  } else {
    object.finish();
    value.fail("\"fromSky\", \"color\", or \"up\" and \"down\"");
  }
  scene.ambient.reflection = object.number("reflection", usualReflection(fromSky), 0, 1);
  object.finish();
  return fromSky;
}

Json describe(float x) {
  const double shortest = std::strtod(formatValue(OptionSpec{}, x).c_str(), nullptr);
  return static_cast<float>(shortest) == x ? shortest : static_cast<double>(x);
}

Json describe(const Vec3f& v) { return Json::array({describe(v.x), describe(v.y), describe(v.z)}); }

Json describe(const Camera& camera) { return describeMembers(camera); }

Json describe(const Ambient& ambient) {
  Json json = ambient.ofSky > 0
                  ? Json{{"fromSky", ambient.ofSky}}
                  : Json{{"up", describe(ambient.up)}, {"down", describe(ambient.down)}};
  if (ambient.occlusion > 0) json["occlusion"] = describe(ambient.occlusion);
  const bool usual = ambient.reflection == usualReflection(ambient.ofSky > 0 ? ambient.ofSky : 1);
  if (!usual) json["reflection"] = describe(ambient.reflection);
  return json;
}

Json describe(const std::vector<Light>& lights) {
  Json list = Json::array();
  for (const Light& light : lights) {
    list.push_back({{"name", light.name}});
    list.back().update(describeMembers(light));
  }
  return list;
}

bool movePaths(Json& json, const std::filesystem::path& from, const std::filesystem::path& to) {
  bool leaves = false;
  for (auto& [key, value] : json.items()) {
    if (value.is_structured()) leaves |= movePaths(value, from, to);
    if (!value.is_string() || (key != "image" && key != "model")) continue;
    const auto text = value.get<std::string>();
    if (text.starts_with("$")) continue;  // $WHIT_DATA, wherever the scene is
    const std::filesystem::path file = absolutePath(from / text);
    const auto data = dataFolder();
    const auto inData = data.empty() ? data : file.lexically_relative(absolutePath(data));
    const auto inFolder = file.lexically_relative(absolutePath(to));
    const bool isData = !inData.empty() && !leavesFolder(inData);
    value = (isData ? "$WHIT_DATA" / inData : inFolder).string();
    leaves |= !isData && leavesFolder(inFolder);
  }
  return leaves;
}

}  // namespace whit
