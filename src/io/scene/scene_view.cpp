#include "io/scene/scene_view.h"

#include <algorithm>

#include "core/options.h"
#include "io/scene/describe_scene.h"
#include "io/scene/read_motion.h"
#include "make/studio_sky.h"

namespace whit {
namespace {

// The node that carries something from now on.
std::uint32_t addMover(const std::shared_ptr<const Motion>& motion, const std::string& name,
                       SceneDescription& scene) {
  scene.motion.rig.push_back({kNoNode, Affine(), motion, name});
  return static_cast<std::uint32_t>(scene.motion.rig.size() - 1);
}

void readMotionOf(JsonObject& object, const Instant& instant, SceneDescription& scene,
                  Camera& camera) {
  const std::shared_ptr<const Motion> motion = readMotion(object, instant, scene);
  if (!motion) return;
  const Camera own = camera;
  carry(own, motion->at(0), camera);
  if (!instant.moves()) return;
  const auto index = static_cast<std::uint32_t>(scene.cameras.size());
  const std::uint32_t mover = addMover(motion, movableName(object, instant), scene);
  scene.motion.cameras.push_back({index, mover, own});
}

void readMotionOf(JsonObject& object, const Instant& instant, SceneDescription& scene,
                  Light& light) {
  const std::shared_ptr<const Motion> motion = readMotion(object, instant, scene);
  if (!motion) return;
  const auto index = static_cast<std::uint32_t>(scene.lights.size());
  const MovingLight moving{index, kNoNode, light.position, light.direction};
  carry(moving, motion->at(0), light);
  if (!instant.moves()) return;
  scene.motion.lights.push_back(moving);
  scene.motion.lights.back().node = addMover(motion, movableName(object, instant), scene);
}

void readPath(JsonObject& file, SceneDescription& scene) {
  const auto path = file.find("path");
  if (!path) return;
  Camera camera = scene.cameras.empty() ? Camera() : scene.cameras.front();
  for (const JsonValue& value : path->elements()) {
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
  if (const auto size = file.find("size")) {
    const auto sides = size->elements(2, "[width, height]");
    scene.width = sides[0].integer(1, kImageSideLimit);
    scene.height = sides[1].integer(1, kImageSideLimit);
  }
  if (const auto cameras = file.find("cameras")) {
    for (const auto& [name, value] : cameras->members()) {
      JsonObject object(value);
      object.need("eye");
      object.need("at");
      Camera camera;
      camera.name = name;
      readCamera(object, camera);
      readMotionOf(object, instant, scene, camera);
      object.finish();
      scene.cameras.push_back(camera);
    }
  }
  readPath(file, scene);
}

void readLights(JsonObject& file, const Instant& instant, SceneDescription& scene) {
  const auto lights = file.find("lights");
  if (!lights) return;
  for (const JsonValue& value : lights->elements()) {
    JsonObject object(value);
    Light light;
    const auto name = object.find("name");
    light.name = name ? name->text() : "light " + std::to_string(scene.lights.size() + 1);
    light.pointer = value.pointer();
    readLight(object, light);
    readMotionOf(object, instant, scene, light);
    object.finish();
    scene.lights.push_back(light);
  }
}

void readSky(JsonObject& file, SceneContext& context) {
  const auto value = file.find("sky");
  if (!value) return;
  JsonObject object(*value);
  Sky& sky = context.scene.sky;
  sky = Sky();
  sky.scale = object.number("scale", sky.scale, 0);
  if (const auto image = object.find("image")) {
    sky.kind = Sky::Kind::image;
    sky.rotation = object.number("rotation", sky.rotation);
    const auto path = context.rules.resolve(image->text(), context.folder, image->where());
    sky.name = path.filename().string();
    if (context.sky.empty()) context.textures.addEnvironment(path.string(), sky.image);
  } else if (const auto preset = object.find("preset")) {
    preset->word({kStudio});
    const float scale = sky.scale;
    sky = studioSky();
    sky.scale = scale;
    sky.rotation = object.number("rotation", sky.rotation);
  } else if (const auto color = object.find("color")) {
    sky.kind = Sky::Kind::color;
    sky.zenith = sky.horizon = sky.ground = color->color();
  } else if (const auto zenith = object.find("zenith")) {
    sky.kind = Sky::Kind::gradient;
    sky.zenith = zenith->color();
    sky.horizon = object.need("horizon").color();
    sky.ground = object.need("ground").color();
  } else {
    object.finish();
    value->fail(
        "a sky with \"color\", with \"zenith\", \"horizon\" and \"ground\", with \"image\" or with "
        "\"preset\"");
  }
  object.finish();
}

std::optional<double> readAmbient(JsonObject& file, SceneDescription& scene) {
  const auto value = file.find("ambient");
  if (!value) return std::nullopt;
  JsonObject object(*value);
  scene.ambient.occlusion = object.number("occlusion", 0, 0);
  std::optional<double> fromSky;
  if (const auto strength = object.find("fromSky")) {
    fromSky = strength->number(0);
    if (scene.sky.kind == Sky::Kind::none) strength->fail("a scene with a sky");
  } else if (const auto color = object.find("color")) {
    scene.ambient.up = scene.ambient.down = color->color();
  } else if (const auto up = object.find("up")) {
    scene.ambient.up = up->color();
    scene.ambient.down = object.need("down").color();
  } else {
    object.finish();
    value->fail("\"fromSky\", \"color\", or \"up\" and \"down\"");
  }
  object.finish();
  return fromSky;
}

Json describe(const Camera& camera) { return describeMembers(camera); }

Json describe(const Ambient& ambient) {
  Json json = ambient.ofSky > 0
                  ? Json{{"fromSky", ambient.ofSky}}
                  : Json{{"up", describe(ambient.up)}, {"down", describe(ambient.down)}};
  if (ambient.occlusion > 0) json["occlusion"] = describe(ambient.occlusion);
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

}  // namespace whit
