#include "io/scene/scene_sections.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/error.h"
#include "core/option_table.h"
#include "core/text.h"
#include "make/studio_sky.h"

namespace whit {

namespace {

// Adds what carries a camera or light to the scene's rig, and returns its number there.
std::uint32_t addMover(const JsonObject& object, const Instant& instant, const SharedMotion& motion,
                       SceneDescription& scene) {
  scene.motion.rig.push_back({kNoNode, Affine(), motion, movableName(object, instant)});
  return size32(scene.motion.rig) - 1;
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

// Checks the members of a camera that depend on each other.
void checkProjection(JsonObject& object, const Camera& camera) {
  const std::vector<float>& k = camera.k;
  if (camera.projection == Projection::fisheye) object.need("k");
  if (!k.empty() && !(k.size() >= 4 && k.size() <= 5 && k[0] > 0 && k[1] > 0)) {
    object.need("k").fail("[fx, fy, cx, cy], fx and fy above 0, and perhaps the skew");
  }

  if (!k.empty() && camera.kSize.size() != 2) {
    object.need("kSize").fail("the [width, height] of the picture that k is for");
  }

  const std::size_t most = isPerspective(camera) ? 8 : 4;
  if (camera.distortion.size() > most) {
    object.need("distortion").fail(concat("at most ", most, " coefficients"));
  }

  if (camera.orthographicHeight > 0 && !(k.empty() && camera.distortion.empty())) {
    object.value().fail("no orthographicHeight beside k or distortion");
  }
  if (isTable(camera) && (camera.azimuths.empty() || camera.elevations.empty())) {
    object.value().fail("azimuths of the columns and elevations of the rows");
  }
}

void readLight(JsonObject& object, Light& light) {
  readMembers(object, light);
  if (light.kind != Light::Kind::point && !(maxComponent(abs(light.direction)) > 0)) {
    object.need("direction").fail("a direction that is not [0, 0, 0]");
  }
  if (light.kind == Light::Kind::spot && !(light.innerConeAngle < light.outerConeAngle)) {
    object.value().fail(
        concat("an innerConeAngle below the outerConeAngle, ", light.outerConeAngle, " degrees"));
  }
}

template <typename Noun>
Json describeMembers(const Noun& noun) {
  Json json;
  forEachMemberInFiles(noun, [&](const auto& member) {
    Json value = describe(noun.*member.field);
    if (value != Json::array()) json[member.name] = std::move(value);
  });
  return json;
}

bool leavesFolder(const std::filesystem::path& path) { return *path.begin() == ".."; }

std::filesystem::path absolutePath(const std::filesystem::path& path) {
  return std::filesystem::weakly_canonical(std::filesystem::current_path() / path);
}

void readSkyImage(const std::filesystem::path& path, const std::string& where,
                  SceneContext& context) {
  Sky& sky = context.scene.sky;
  sky.kind = Sky::Kind::image;
  sky.name = std::filesystem::absolute(path).lexically_normal().string();
  if (sky.name != context.knownSky) {
    context.textures.addEnvironment(path.string(), where, sky.image);
  }
}

void setStudio(SceneContext& context) {
  Sky& sky = context.scene.sky;
  if (context.knownSky != kStudio) {
    sky = studioSky();
    return;
  }
  sky.kind = Sky::Kind::image;
  sky.name = kStudio;
}

constexpr double kLeastScale = 1e-9, kLargestScale = 1e9;

// A key has three numbers of translation, the degrees, and three numbers of scale.
constexpr std::size_t kKeyNumbers = 7;

Vec3d readKeyScale(const JsonValue& value) {
  const Vec3d scale = value.isNumber() ? Vec3d(value.number()) : value.vector();
  for (const double s : {scale.x, scale.y, scale.z}) {
    if (!(s >= kLeastScale && s <= kLargestScale)) value.fail("a scale above 0");
  }
  return scale;
}

// Reads the rotation of a key, in degrees. `axis` is 0 before the first rotation.
double readDegrees(const JsonValue& value, Vec3d& axis) {
  const auto [about, degrees] = readTurn(value);
  if (axis == Vec3d()) axis = about;
  if (!(axis == about)) value.fail("the axis of the keys before: groups turn about several");
  return degrees;
}

void readKey(const JsonValue& value, Track& track, Vec3d& axis) {
  JsonObject key(value);
  const JsonValue time = key.need("time"), translate = key.find("translate");
  const JsonValue rotate = key.find("rotate"), scale = key.find("scale");
  if (!track.times.empty() && !(time.number() > track.times.back())) {
    time.fail("a time after that of the key before");
  }
  track.times.push_back(time.number());

  const Vec3d t = translate ? translate.vector() : Vec3d();
  const double degrees = rotate ? readDegrees(rotate, axis) : 0;
  const Vec3d s = scale ? readKeyScale(scale) : Vec3d(1.0);
  track.values.insert(track.values.end(), {t.x, t.y, t.z, degrees, s.x, s.y, s.z});

  key.finish();
}

// Gives each key the slope of the line between its neighbors as tangent. The first and the last key
// have one neighbor, unless a loop ends as it begins: then the loop goes on through them.
void addTangents(bool loops, Track& track) {
  const std::size_t last = track.times.size() - 1;
  const auto value = [&](std::size_t key) {
    return std::span(track.values).subspan(key * kKeyNumbers, kKeyNumbers);
  };
  const bool closed = loops && last > 1 && std::ranges::equal(value(0), value(last));

  std::vector<double> all;
  for (std::size_t i = 0; i <= last; ++i) {
    const bool joined = closed && (i == 0 || i == last);
    const std::size_t a = joined ? last - 1 : i - std::min<std::size_t>(i, 1);
    const std::size_t b = joined ? 1 : std::min(i + 1, last);
    double span = track.times[b] - track.times[a];
    if (joined) span += track.times[last] - track.times[0];

    std::vector<double> tangent(kKeyNumbers);
    for (std::size_t k = 0; a != b && k < kKeyNumbers; ++k) {
      tangent[k] = (value(b)[k] - value(a)[k]) / span;
    }
    all.insert(all.end(), tangent.begin(), tangent.end());
    all.insert(all.end(), value(i).begin(), value(i).end());
    all.insert(all.end(), tangent.begin(), tangent.end());
  }
  track.values = std::move(all);
}

Track::Interpolation readInterpolation(JsonObject& motion) {
  const JsonValue value = motion.find("interpolation");
  const std::string word = value ? value.word({"linear", "step", "cubic"}) : "linear";
  if (word == "step") return Track::Interpolation::step;
  return word == "cubic" ? Track::Interpolation::cubic : Track::Interpolation::linear;
}

double looped(double seconds, double first, double last) {
  const double period = last - first;
  if (!(period > 0)) return first;
  double within = std::fmod(seconds - first, period);
  if (within < 0) within += period;

  // At the end of a loop the next one begins. Rounding may leave the time just before that.
  constexpr double kRounding = 1e-9;
  return period - within > kRounding * period ? first + within : first;
}

// Counts a motion of the file as part of the scene's animation kSceneMotion.
void countMotion(double seconds, SceneDescription& scene) {
  const auto known = std::ranges::find(scene.animations, kSceneMotion, &Animation::name);
  Animation& all = known != scene.animations.end() ? *known : scene.animations.emplace_back();
  all.name = kSceneMotion;
  all.seconds = std::max(all.seconds, seconds);
  ++all.nodes;
}

}  // namespace

void readCamera(JsonObject& object, Camera& camera) {
  readMembers(object, camera);
  const Vec3d forward = Vec3d(camera.at) - Vec3d(camera.eye);
  if (forward == Vec3d()) object.value().fail("eye and at to differ");
  const Vec3d right = cross(normalized(forward), normalized(Vec3d(camera.up)));
  constexpr double kLeastSine = 1e-6;
  if (!(length(right) > kLeastSine)) object.value().fail("an up that is not along the view");
  checkProjection(object, camera);
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

    const auto index = size32(scene.cameras);
    if (const SharedMotion motion = readMotion(object, instant, scene)) {
      if (instant.moves()) {
        scene.motion.cameras.push_back({index, addMover(object, instant, motion, scene), camera});
      }
      carry(Camera(camera), (*motion)(0), camera);
    }

    object.finish();
    scene.cameras.push_back(camera);
  }
  readPath(file, scene);
}

void readOptions(JsonObject& file, SceneDescription& scene) {
  const std::vector<std::string> names = sceneOptionNames();
  RenderOptions checked;
  for (const auto& [name, value] : file.find("options").members()) {
    if (!contains(names, name)) {
      throwBadScene(value.where(), "expected an option of the picture" + suggestion(name, names) +
                                       ", found \"" + excerpt(name) + "\"");
    }

    if (value.isObject() || value.isArray() || value.isNull()) {
      value.fail("a number, a word, true or false");
    }
    std::string text;
    if (value.isNumber()) {
      text = shortest(value.number());
    } else if (value.isText()) {
      text = value.text();
    } else {
      text = value.flag() ? "on" : "off";
    }

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
    light.name = object.find("name").textOr(concat("light ", scene.lights.size() + 1));
    light.pointer = value.pointer();
    readLight(object, light);

    MovingLight moving{size32(scene.lights), kNoNode, light.position, light.direction};
    if (const SharedMotion motion = readMotion(object, instant, scene)) {
      if (instant.moves()) {
        moving.node = addMover(object, instant, motion, scene);
        scene.motion.lights.push_back(moving);
      }
      carry(moving, (*motion)(0), light);
    }

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
  const float scale = object.number("scale", sky.scale, 0);

  if (const JsonValue image = object.find("image")) {
    sky.kind = Sky::Kind::image;
    sky.rotation = object.number("rotation", sky.rotation);
    const auto path = context.rules.resolve(image.text(), context.folder, image.where());
    if (context.sky.empty()) readSkyImage(path, image.where(), context);
  } else if (const JsonValue preset = object.find("preset")) {
    preset.word({kStudio});
    setStudio(context);
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

  sky.scale = scale;
  object.finish();
}

void replaceSky(SceneContext& context) {
  Sky& sky = context.scene.sky;
  if (context.sky.empty() || (context.sky == kStudio && sky.name == kStudio)) return;

  sky = Sky();
  if (context.sky == kNoSky) return;
  if (context.sky == kStudio) {
    setStudio(context);
  } else {
    readSkyImage(context.sky, "--sky", context);
  }
}

// Returns the default of "reflection": the ambient light's share of the sky, which says how open
// the scene is.
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
    const bool hasSky = scene.sky.kind != Sky::Kind::none || file.has("view");
    if (!hasSky) strength.fail("a scene with a sky");
  } else if (const JsonValue color = object.find("color")) {
    scene.ambient.up = scene.ambient.down = color.color();
  } else if (const JsonValue up = object.find("up")) {
    scene.ambient.up = up.color();
    scene.ambient.down = object.need("down").color();
  } else if (!object.has("occlusion") && !object.has("reflection")) {
    object.finish();
    value.fail("\"fromSky\", \"color\", \"up\" and \"down\", \"occlusion\" or \"reflection\"");
  }

  scene.ambient.reflection = object.number("reflection", usualReflection(fromSky), 0, 1);
  object.finish();
  return fromSky;
}

Json describe(float x) {
  double shortest = 0;
  readNumber(formatValue(OptionSpec{}, x), shortest);
  return static_cast<float>(shortest) == x ? shortest : double{x};
}

Json describe(const Vec3f& v) { return Json::array({describe(v.x), describe(v.y), describe(v.z)}); }

Json describe(const std::vector<float>& numbers) {
  Json list = Json::array();
  for (const float x : numbers) list.push_back(describe(x));
  return list;
}

Json describe(const Camera& camera) {
  Json json = describeMembers(camera);
  if (!seesByFov(camera)) json.erase("fov");
  return json;
}

void movePoints(Json& noun, const Vec3d& offset) {
  if (offset == Vec3d() || !noun.is_object()) return;
  for (const char* name : {"eye", "at", "position"}) {
    if (!noun.contains(name) || !noun[name].is_array() || noun[name].size() != 3) continue;
    for (int i = 0; i < 3; ++i) {
      Json& number = noun[name][i];
      if (number.is_number()) number = number.get<double>() + offset[i];
    }
  }
}

void moveLights(Json& root, const Vec3d& offset) {
  if (!root.contains("lights") || !root["lights"].is_array()) return;
  for (Json& light : root["lights"]) movePoints(light, offset);
}

Json describe(const Ambient& ambient) {
  Json json = ambient.ofSky > 0
                  ? Json{{"fromSky", ambient.ofSky}}
                  : Json{{"up", describe(ambient.up)}, {"down", describe(ambient.down)}};
  json["occlusion"] = describe(ambient.occlusion);
  const bool usual = ambient.reflection == usualReflection(ambient.ofSky > 0 ? ambient.ofSky : 1);
  if (!usual) json["reflection"] = describe(ambient.reflection);
  return json;
}

Json describe(const Sky& sky) {
  if (sky.kind == Sky::Kind::none) return {{"color", 0}};

  Json json{{"scale", describe(sky.scale)}};
  if (sky.kind == Sky::Kind::image) {
    json["rotation"] = describe(sky.rotation);
    json[sky.name == kStudio ? "preset" : "image"] = sky.name;
  } else if (sky.kind == Sky::Kind::color) {
    json["color"] = describe(sky.zenith);
  } else {
    json["zenith"] = describe(sky.zenith);
    json["horizon"] = describe(sky.horizon);
    json["ground"] = describe(sky.ground);
  }
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

std::pair<Vec3d, double> readTurn(const JsonValue& value) {
  const auto e = value.elements(4, "a rotation [x, y, z, degrees]");
  const Vec3d axis{e[0].number(), e[1].number(), e[2].number()};
  if (axis == Vec3d()) value.fail("an axis other than 0");
  return {axis, e[3].number()};
}

std::string movableName(const JsonObject& object, const Instant& instant) {
  const std::string& pointer = object.value().pointer();
  return instant.movable.contains(pointer) ? pointer : std::string();
}

SharedMotion readMotion(JsonObject& object, const Instant& instant, SceneDescription& scene) {
  const JsonValue value = object.find("motion");
  if (!value) {
    if (movableName(object, instant).empty()) return nullptr;
    return fixedMotion(Affine());
  }

  JsonObject motion(value);
  const JsonValue list = motion.need("keys");
  Track track{readInterpolation(motion), false, kKeyNumbers, {}, {}};
  Vec3d axis;  // 0: nothing is turned
  for (const JsonValue& key : list.elements()) readKey(key, track, axis);
  if (track.times.empty()) list.fail("at least one key");
  const bool loops = motion.find("loop").flagOr(false);
  motion.finish();
  if (track.interpolation == Track::Interpolation::cubic) addTangents(loops, track);

  countMotion(track.times.back(), scene);
  return std::make_shared<const Motion>([track, axis, loops](double seconds) {
    const std::vector<double> v =
        valueAt(track, loops ? looped(seconds, track.times.front(), track.times.back()) : seconds);
    const Vec3d scale = max(Vec3d(v[4], v[5], v[6]), Vec3d(kLeastScale));  // cubic may overshoot
    return Affine::translation({v[0], v[1], v[2]}) * Affine::rotation(axis, v[3]) *
           Affine::scaling(scale);
  });
}

}  // namespace whit
