// Edits as settings of the scene.
#include "io/scene/describe_scene.h"
#include "io/scene/scene_view.h"
#include "viewer/traced_frame.h"

namespace whit::view {

namespace {

template <typename Item>
class Differences {
 public:
  Differences(const Item& read, const Item& edited, std::vector<std::string>& settings)
      : read_(read), edited_(edited), settings_(settings) {}

  template <typename Field>
  bool changed(Field Item::*field) const {
    return !(read_.*field == edited_.*field);
  }
  template <typename Field>
  void add(const char* name, Field Item::*field) {
    if (changed(field)) say(name, describe(edited_.*field));
  }
  void say(const char* name, const Json& value) {
    settings_.push_back(edited_.pointer + "/" + name + "=" + value.dump());
  }

 private:
  const Item& read_;
  const Item& edited_;
  std::vector<std::string>& settings_;
};

// Whoever sets one member leaves others of the same material to follow: these are set as well.
void addMaterial(const Material& read, const Material& edited, std::vector<std::string>& settings) {
  Differences<Material> d(read, edited, settings);
  d.add("diffuse", &Material::diffuse);
  d.add("specular", &Material::specular);
  if (!read.hasGlossy() && edited.hasGlossy() && edited.specularMap == kNoTexture) {
    d.say("specularMap", nullptr);  // which a model may have that has no use for it
  }
  d.add("roughness", &Material::roughness);
  d.add("emission", &Material::emission);
  d.add("mirror", &Material::mirror);
  if (d.changed(&Material::mirror)) {
    d.say("mirrorGrazing", describe(edited.mirrorGrazing));
  } else {
    d.add("mirrorGrazing", &Material::mirrorGrazing);
  }
  d.add("transmission", &Material::transmission);
  if (d.changed(&Material::transmission)) d.say("castsShadow", read.castsShadow);
  if (d.changed(&Material::mirror) || d.changed(&Material::mirrorGrazing) ||
      d.changed(&Material::transmission)) {
    d.say("glossyReflection", edited.glossyReflection);
  }
  d.add("ior", &Material::ior);
  d.add("absorption", &Material::absorption);
}

void addLight(const Light& read, const Light& edited, std::vector<std::string>& settings) {
  const bool directional = edited.kind == Light::Kind::directional;
  Differences<Light> d(read, edited, settings);
  d.add("position", &Light::position);
  d.add(directional ? "irradiance" : "intensity", &Light::intensity);
  d.add("direction", &Light::direction);
  d.add("innerConeAngle", &Light::innerConeAngle);
  d.add("outerConeAngle", &Light::outerConeAngle);
}

// `whole`: also what has not changed.
void addSky(const SkyChoice& read, const SkyChoice& edited, bool whole,
            std::vector<std::string>& settings) {
  const auto say = [&](const char* pointer, const Json& value) {
    settings.push_back(pointer + ("=" + value.dump()));
  };
  if (edited == read && !whole) return;
  if (!edited.source.empty()) return say("/sky", describeSky(edited));
  if (edited.scale != read.scale) say("/sky/scale", describe(edited.scale));
  if (edited.rotation != read.rotation) say("/sky/rotation", describe(edited.rotation));
}

}  // namespace

ShadingEdit withoutEdits(const std::shared_ptr<const cli::OpenScene>& scene) {
  return {scene,         scene->scene.materials, scene->scene.lights,
          skyOf(*scene), scene->scene.ambient,   {}};
}

std::vector<std::string> editSettings(const ShadingEdit& read, const ShadingEdit& edited) {
  std::vector<std::string> settings;
  for (std::size_t i = 0; i < read.lights.size(); ++i) {
    addLight(read.lights[i], edited.lights[i], settings);
  }
  for (std::size_t i = 0; i < read.materials.size(); ++i) {
    addMaterial(read.materials[i], edited.materials[i], settings);
  }
  const bool ambientChanged = !sameAmbient(read.ambient, edited.ambient);
  // Ambient light is made from a sky of the scene's own, which one given by --sky is not.
  addSky(read.sky, edited.sky, ambientChanged && edited.ambient.ofSky > 0, settings);
  // A model's own would follow another sky.
  const bool ambientFollows = read.scene && read.scene->scene.isModel && edited.sky != read.sky;
  if (ambientFollows || ambientChanged) {
    settings.push_back("/ambient=" + describe(edited.ambient).dump());
  }
  return settings;
}

}  // namespace whit::view
