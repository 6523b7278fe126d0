#include "viewer/sky_choice.h"

#include <filesystem>

#include "io/scene/describe_scene.h"
#include "io/supply_view.h"
#include "make/studio_sky.h"

namespace whit::view {

SkyChoice skyOf(const cli::OpenScene& scene) {
  const Sky& sky = scene.scene.sky;
  SkyChoice choice{"", sky.kind, sky.scale, sky.rotation};
  if (!scene.sky.empty()) {
    choice.source = chooseSky(scene.sky).source;
  } else if (sky.name == kStudio) {
    choice.source = kStudio;
  }
  return choice;
}

SkyChoice chooseSky(const std::string& source) {
  if (source == kNoSky) return {source};
  if (source == kStudio) return {source, Sky::Kind::image};
  return {std::filesystem::absolute(source).lexically_normal().string(), Sky::Kind::image};
}

Json describeSky(const SkyChoice& sky) {
  if (sky.kind == Sky::Kind::none) return {{"color", 0}};
  Json json{{"scale", describe(sky.scale)}, {"rotation", describe(sky.rotation)}};
  json[sky.source == kStudio ? "preset" : "image"] = sky.source;
  return json;
}

}  // namespace whit::view
