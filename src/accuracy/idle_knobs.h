// Scenes in which a knob does nothing, and why (see Idle).
#pragma once

#include <string>

#include "core/effects.h"

namespace whit::accuracy {

std::string never(EffectSet effects);  // nowhere
std::string withoutImpulses(EffectSet effects);
std::string withoutGlossyReflection(EffectSet effects);
std::string withoutTransmission(EffectSet effects);
std::string withoutLights(EffectSet effects);
std::string withoutShadows(EffectSet effects);
std::string withoutSmoothShadows(EffectSet effects);
std::string withoutBentImpulses(EffectSet effects);
std::string withoutTextures(EffectSet effects);
std::string withoutSecondaryRays(EffectSet effects);
std::string whereRaysBranch(EffectSet effects);

}  // namespace whit::accuracy
