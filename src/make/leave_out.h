// Leaves effects out of a scene, and lists the order in which `whit effects` adds them again.
// Measurements and tests compare a scene with itself in this way.
#pragma once

#include <array>

#include "core/effects.h"
#include "scene/description.h"

namespace whit {

// Removes what turns each effect on (see effects_of_scene.cpp), so that the scene calls for all
// other effects and for none of these. Masked surfaces become solid, a sky image becomes a
// gradient, glass becomes opaque, spheres become triangles, and of each object the first instance
// remains. Without the mirror effect, dielectrics get the refractive index of the vacuum,
// because others reflect.
void leaveOut(SceneDescription& description, EffectSet effects);

// Effects of the matte scene: primary and shadow rays, lights that shine all around.
inline constexpr EffectSet kMatteEffects = EffectSet().with(Effect::lights).with(Effect::shadows);

// Effects that are added to the matte scene, in this order: each needs only those before it.
inline constexpr std::array kAddedEffects{
    Effect::spotLights,  Effect::directionalLights, Effect::ambient,          Effect::emission,
    Effect::sky,         Effect::skyImage,          Effect::smoothNormals,    Effect::vertexColors,
    Effect::textures,    Effect::emissionMaps,      Effect::normalMaps,       Effect::alphaMasks,
    Effect::glossy,      Effect::blurredSky,        Effect::instances,        Effect::spheres,
    Effect::mirror,      Effect::transmission,      Effect::absorption,       Effect::coverage,
    Effect::softShadows, Effect::glossyReflection,  Effect::ambientOcclusion, Effect::fog,
    Effect::indirect,    Effect::depthOfField,
};
static_assert(kAddedEffects.size() + 2 == kEffectCount);

}  // namespace whit
