#include "bake/edit_shading.h"

#include <algorithm>
#include <utility>

#include "bake/finalize_steps.h"
#include "core/error.h"
#include "scene/members.h"

namespace whit {

namespace {

// Exchanging one for the other neither adds nor removes an effect or a medium.
bool sameKind(const Material& a, const Material& b) {
  const bool sameMedium = !a.boundsMedium() || (a.ior == b.ior && a.absorption == b.absorption &&
                                                a.priority == b.priority);
  return sameMedium && a.boundsMedium() == b.boundsMedium() && effectsOf(a) == effectsOf(b);
}

bool sameKindOfLight(const Light& a, const Light& b) {
  return a.kind == b.kind && hasExtent(a) == hasExtent(b) &&
         isBlack(a.intensity) == isBlack(b.intensity);
}

void keepBaked(const Material& from, Material& to) {
  forEachMember<Material>([&](const auto& member) {
    if (member.rules.baked) to.*member.field = from.*member.field;
  });
}

}  // namespace

void editShading(Scene& scene, std::vector<Material> materials, std::vector<Light> lights) {
  if (materials.size() != scene.materials.size() || lights.size() != scene.lights.size()) {
    throwUsage("an edit cannot change the number of materials or lights");
  }
  SceneDescription d;
  d.name = scene.name;
  d.lights = lights;
  d.materials = materials;
  validate(d);
  for (std::size_t i = 0; i < materials.size(); ++i) keepBaked(scene.materials[i], materials[i]);
  const bool kindsStay = std::ranges::equal(materials, scene.materials, sameKind) &&
                         std::ranges::equal(lights, scene.lights, sameKindOfLight);
  scene.materials.swap(materials);
  scene.lights.swap(lights);
  if (kindsStay) return;
  try {
    numberMedia(scene);
  } catch (...) {  // too many media
    scene.materials.swap(materials);
    scene.lights.swap(lights);
    numberMedia(scene);
    throw;
  }
  gatherEffects(scene);
}

void editSky(Scene& scene, Sky& sky, const Ambient& ambient) {
  validate(scene.name, sky, ambient);
  std::swap(scene.sky, sky);
  scene.ambient = ambient;
  gatherEffects(scene);
}

}  // namespace whit
