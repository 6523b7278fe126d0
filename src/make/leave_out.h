// Leaving effects out of a scene: what remains calls for all the others and for none of
// those; and the order in which `whit effects` adds them one after the other. Measures and tests
// compare a scene with itself in this way.
#pragma once

#include <algorithm>
#include <array>
#include <bit>

#include "core/effects.h"
#include "scene/description.h"

namespace whit {

// Takes out what turns each effect on (see effects_of_scene.cpp): textures and normal maps, whose
// texels go too when no material is left that uses them; alpha masks, so that masked surfaces
// become solid; vertex normals; lobes, emission, lights; that diffuse surfaces reflect the scene;
// the sky, or of a sky image only the image, in whose place comes a gradient; mirrors, transmission
// (glass becomes opaque), absorption, coverage (what is there in part becomes whole); all uses of
// an object but the first; of a sphere that it is round: it becomes triangles. Without shadows
// nothing casts any. Without mirror dielectrics get the refractive index of the vacuum, because
// others reflect.
void leaveOut(SceneDescription& description, EffectSet effects);

// Effects of the matte scene: primary and shadow rays, lights that shine all around.
inline constexpr EffectSet kMatteEffects = EffectSet().with(Effect::lights).with(Effect::shadows);

// Effects that are added to it, in this order: each needs only those before it. Effects that others
// need, or that most scenes have, are listed here; the rest follows in the order of core/effects.h.
inline constexpr std::array kAddedEffects = [] {
  constexpr std::array kFirst{
      Effect::spotLights,  Effect::directionalLights, Effect::ambient,       Effect::emission,
      Effect::sky,         Effect::skyImage,          Effect::smoothNormals, Effect::vertexColors,
      Effect::textures,    Effect::emissionMaps,      Effect::normalMaps,    Effect::alphaMasks,
      Effect::glossy,      Effect::glossyReflection,  Effect::instances,     Effect::spheres,
      Effect::mirror,      Effect::transmission,      Effect::absorption,    Effect::coverage,
      Effect::softShadows,
  };
  std::array<Effect, kEffectCount - std::popcount(kMatteEffects.bits())> added{};
  auto end = std::copy(kFirst.begin(), kFirst.end(), added.begin());
  for (int i = 0; i < kEffectCount; ++i) {
    const auto effect = static_cast<Effect>(i);
    const bool there = std::find(added.begin(), end, effect) != end || kMatteEffects.has(effect);
    if (!there) *end++ = effect;
  }
  return added;
}();

}  // namespace whit
