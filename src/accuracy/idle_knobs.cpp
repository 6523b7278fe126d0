#include "accuracy/idle_knobs.h"

namespace whit::accuracy {

std::string never(EffectSet) { return {}; }

std::string withoutImpulses(EffectSet effects) {
  if (effects.has(Effect::mirror) || effects.has(Effect::transmission)) return {};
  return "nothing in the scene reflects or refracts";
}
std::string withoutGlossyReflection(EffectSet effects) {
  return effects.has(Effect::glossyReflection) ? "" : "no glossy lobe in the scene reflects it";
}
std::string withoutTransmission(EffectSet effects) {
  return effects.has(Effect::transmission) ? "" : "nothing in the scene is transparent";
}
std::string withoutLights(EffectSet effects) {
  return effects.has(Effect::lights) ? "" : "the scene has no light";
}
std::string withoutShadows(EffectSet effects) {
  return effects.has(Effect::shadows) ? "" : "nothing in the scene casts a shadow";
}
std::string withoutSmoothShadows(EffectSet effects) {
  return effects.has(Effect::smoothNormals) ? withoutShadows(effects) : "all surfaces are flat";
}
std::string withoutBentImpulses(EffectSet effects) {
  const bool bent = effects.has(Effect::smoothNormals) || effects.has(Effect::normalMaps);
  return bent ? withoutImpulses(effects) : "all surfaces are flat";
}
std::string withoutTextures(EffectSet effects) {
  if (effects.has(Effect::textures) || effects.has(Effect::normalMaps)) return {};
  return "the scene has no texture";
}
std::string withoutSecondaryRays(EffectSet effects) {
  return effects.has(Effect::shadows) ? std::string() : withoutImpulses(effects);
}
std::string whereRaysBranch(EffectSet effects) {
  if (!effects.has(Effect::transmission)) return {};
  return "without a cutoff the rays of both impulses double with every bounce";
}

}  // namespace whit::accuracy
