#include "io/supply_view.h"

#include <algorithm>

#include "io/image/image_file.h"
#include "io/image/texture_from_image.h"
#include "make/light_level.h"
#include "make/model_view.h"
#include "make/studio_sky.h"

namespace whit {

namespace {

// The usual level of the supplied light, which the studio's brightness suits.
constexpr double kUsualLevel = 0.5;
constexpr double kDimmest = 1.0e-6, kBrightest = 1.0e6;

// White surfaces that face the light from `distance` are seen as `level`.
Light supplied(const char* name, const Vec3f& position, float distance, float level, float size) {
  Light light;
  light.name = name;
  light.position = position;
  light.intensity = Rgb(level * 3.14159265f * distance * distance);
  light.radius = 0.01f * size;
  return light;
}

// A light above, beside and in front of the model, and a weak one from the other side, without
// which rough metals would be black there: ambient light is for what is diffuse. In a room a lamp
// below its ceiling, as bright as the first light about half across the room.
void supplyLights(const ModelView& view, SceneDescription& scene) {
  constexpr float kFill = 0.25f, kAcross = 0.4f;
  const float size = std::max(static_cast<float>(2 * view.radius), 1e-6f);
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

// A supplied camera has to see the whole animation that is played.
ModelView viewOf(const SceneContext& context) {
  const SceneDescription& scene = context.scene;
  const std::string& played = context.instant.animation;
  for (const Animation& animation : scene.animations) {
    if (!scene.cameras.empty() || !context.instant.moves()) break;
    if (played.empty() || animation.name == played) return viewOf(scene, animation.seconds);
  }
  return viewOf(scene);
}

}  // namespace

void supplyView(SceneContext& context) {
  SceneDescription& scene = context.scene;
  const ModelView view = viewOf(context);
  scene.isModel = true;
  if (context.sky.empty() || context.sky == kStudio) scene.sky = studioSky();
  if (scene.lights.empty()) {
    supplyLights(view, scene);
  } else if (const double level = lightLevel(scene); level > 0) {
    scene.sky.scale = static_cast<float>(std::clamp(level / kUsualLevel, kDimmest, kBrightest));
  }
  if (scene.cameras.empty() && view.radius > 0) scene.cameras.push_back(view.camera);
}

void replaceSky(SceneContext& context) {
  Sky& sky = context.scene.sky;
  if (context.sky.empty() || (context.sky == kStudio && sky.name == kStudio)) return;
  sky = context.sky == kStudio ? studioSky() : Sky();
  if (context.sky == kStudio || context.sky == kNoSky) return;
  sky.kind = Sky::Kind::image;
  sky.name = context.sky;
  context.textures.addEnvironment(context.sky, sky.image);
}

Sky namedSky(const std::string& name, std::uint64_t mostBytes, Warnings& warnings) {
  if (name == kStudio) return studioSky();
  Sky sky;
  if (name == kNoSky) return sky;
  MemoryBudget budget(mostBytes);
  ImageLimits limits;
  limits.budget = &budget;
  sky.kind = Sky::Kind::image;
  sky.name = name;
  sky.image = makeEnvironment(readRawImage(name, limits, warnings));
  return sky;
}

}  // namespace whit
