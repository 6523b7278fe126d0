#include "reference/write_emitted_and_reflective_ambient.h"

namespace whit::reference {

RgbD skyAlong(const Scene& scene, EffectSet effects, const Vec3d& direction) {
  if (!effects.has(Effect::sky)) return {};
  if (scene.sky.kind == Sky::Kind::image && !effects.has(Effect::skyImage)) return {};
  return skyRadiance(scene.sky, direction);
}

RgbD reflectedAmbient(const Scene& scene, EffectSet effects, const Surfel& surfel) {
  if (!effects.has(Effect::ambient)) return {};
  if (scene.materials[surfel.material].diffuses(effects)) return {};
  const RgbD up(scene.ambient.up), down(scene.ambient.down);
  return surfel.diffuse * (down + (up - down) * (0.5 + 0.5 * surfel.shadingNormal.y));
}

RgbD emittedAndAmbient(const Scene& scene, EffectSet effects, const Surfel& surfel) {
  RgbD radiance;
  if (effects.has(Effect::emission)) {
    radiance = RgbD(scene.materials[surfel.material].emission) * surfel.emission;
  }
  if (!isOccluded(scene.ambient, effects)) radiance += reflectedAmbient(scene, effects, surfel);
  return radiance * surfel.coverage;
}

RadianceRow writeEmittedAndReflectiveAmbient(const World& world, const Chunk& chunk,
                                             std::size_t slot) {
  RgbD radiance;
  if (chunk.surfels.material[slot] == kMiss) {
    radiance = skyAlong(world.scene, world.effects, rayOf(chunk, slot).direction);
  } else if (!isHidden(chunk, slot)) {
    radiance = emittedAndAmbient(world.scene, world.effects, surfelOf(chunk, slot));
  }
  return {radiance.x, radiance.y, radiance.z};
}

}  // namespace whit::reference
