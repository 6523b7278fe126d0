// One effect after the other: the order in which `whit effects` adds them to a scene.
#pragma once

#include <array>

#include "core/effects.h"

namespace whit {

// What the matte scene starts with: primary and shadow rays, lights that shine all around.
inline constexpr EffectSet kMatteEffects = EffectSet().with(Effect::lights).with(Effect::shadows);

// Each needs only those before it.
inline constexpr std::array kAddedEffects{
    Effect::spotLights,   Effect::directionalLights, Effect::ambient,       Effect::emission,
    Effect::sky,          Effect::skyImage,          Effect::smoothNormals, Effect::vertexColors,
    Effect::textures,     Effect::emissionMaps,      Effect::normalMaps,    Effect::alphaMasks,
    Effect::glossy,       Effect::glossyReflection,  Effect::instances,     Effect::mirror,
    Effect::transmission, Effect::absorption,
};
static_assert(kAddedEffects.size() + 2 == kEffectCount);

}  // namespace whit
