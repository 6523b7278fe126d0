// writeEmittedAndReflectiveAmbient: what a ray brings without lights and without further rays.
#pragma once

#include "reference/twin.h"

namespace whit::reference {

// Radiance of the sky along the unit direction, black where the effects leave it out.
inline RgbD skyAlong(const Scene& scene, EffectSet effects, const Vec3d& direction) {
  if (!effects.has(Effect::sky)) return {};
  if (scene.sky.kind == Sky::Kind::image && !effects.has(Effect::skyImage)) return {};
  return skyRadiance(scene.sky, direction);
}

// Ambient light reflected by the diffuse color, of the part of the surface that is there: black
// where that reflects the scene instead.
inline RgbD reflectedAmbient(const Scene& scene, EffectSet effects, const Surfel& surfel) {
  if (!effects.has(Effect::ambient)) return {};
  if (scene.materials[surfel.material].diffuses(effects)) return {};
  const RgbD up(scene.ambient.up), down(scene.ambient.down);
  return surfel.diffuse * (down + (up - down) * (0.5 + 0.5 * surfel.shadingNormal.y));
}

// Emission, and ambient light that nothing is looked for to hold off.
inline RgbD emittedAndAmbient(const Scene& scene, EffectSet effects, const Surfel& surfel) {
  RgbD radiance;
  if (effects.has(Effect::emission)) {
    radiance = RgbD(scene.materials[surfel.material].emission) * surfel.emission;
  }
  if (!isOccluded(scene.ambient, effects)) radiance += reflectedAmbient(scene, effects, surfel);
  return radiance * surfel.coverage;
}

// The row that the step writes.
inline RadianceRow writeEmittedAndReflectiveAmbient(const World& world, const Chunk& chunk,
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
