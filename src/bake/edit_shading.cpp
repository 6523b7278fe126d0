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

// Validates like Scene::finalize(): throws, or repairs to the nearest sensible value.
void checkAndMend(const Scene& scene, std::vector<Material>& materials,
                  std::vector<Light>& lights) {
  SceneDescription d;
  d.name = scene.name;
  d.lights = lights;
  d.materials = materials;
  for (Material& m : d.materials) {  // maps were judged with the textures that they name
    forEachMap([&](const auto& member) { m.*member.field = kNoTexture; });
  }
  Warnings warnings(false);
  validate(d, warnings);
  materials = std::move(d.materials);
  lights = std::move(d.lights);
}

}  // namespace

void editShading(Scene& scene, std::vector<Material> materials, std::vector<Light> lights) {
  if (materials.size() != scene.materials.size() || lights.size() != scene.lights.size()) {
    throwUsage("an edit cannot change the number of materials or lights");
  }
  checkAndMend(scene, materials, lights);
  for (std::size_t i = 0; i < materials.size(); ++i) keepBaked(scene.materials[i], materials[i]);
  const bool kindsStay =
      std::equal(materials.begin(), materials.end(), scene.materials.begin(), sameKind) &&
      std::equal(lights.begin(), lights.end(), scene.lights.begin(), sameKindOfLight);
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
  SceneDescription d;
  d.name = scene.name;
  d.sky = std::move(sky);
  d.ambient = ambient;
  Warnings warnings(false);
  try {
    validate(d, warnings);
  } catch (...) {
    sky = std::move(d.sky);
    throw;
  }
  sky = std::exchange(scene.sky, std::move(d.sky));
  scene.ambient = ambient;
  gatherEffects(scene);
}

}  // namespace whit
