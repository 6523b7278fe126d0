// Edits of materials and lights as settings of the scene.
#include <cstdlib>

#include "core/option_values.h"
#include "io/json_text.h"
#include "viewer/traced_frame.h"

namespace whit::view {

namespace {

// The shortest decimals that are read as this float.
Json jsonOf(float x) {
  const double shortest = std::strtod(formatValue(OptionSpec{}, x).c_str(), nullptr);
  return static_cast<float>(shortest) == x ? shortest : static_cast<double>(x);
}
Json jsonOf(const Vec3f& v) { return Json::array({jsonOf(v.x), jsonOf(v.y), jsonOf(v.z)}); }
Json jsonOf(bool flag) { return flag; }

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
    if (changed(field)) say(name, jsonOf(edited_.*field));
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
    d.say("mirrorGrazing", jsonOf(edited.mirrorGrazing));
  } else {
    d.add("mirrorGrazing", &Material::mirrorGrazing);
  }
  d.add("transmission", &Material::transmission);
  if (d.changed(&Material::transmission)) d.say("castsShadow", jsonOf(read.castsShadow));
  if (d.changed(&Material::mirror) || d.changed(&Material::mirrorGrazing) ||
      d.changed(&Material::transmission)) {
    d.say("glossyReflection", jsonOf(edited.glossyReflection));
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

}  // namespace

std::vector<std::string> editSettings(const ShadingEdit& read, const ShadingEdit& edited) {
  std::vector<std::string> settings;
  for (std::size_t i = 0; i < read.lights.size(); ++i) {
    addLight(read.lights[i], edited.lights[i], settings);
  }
  for (std::size_t i = 0; i < read.materials.size(); ++i) {
    addMaterial(read.materials[i], edited.materials[i], settings);
  }
  return settings;
}

}  // namespace whit::view
