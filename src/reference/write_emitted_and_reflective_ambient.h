// writeEmittedAndReflectiveAmbient: what a ray brings without lights and without further rays.
#pragma once

#include <algorithm>
#include <cmath>

#include "reference/add_impulses.h"
#include "reference/world.h"

namespace whit::reference {

// Radiance of the sky along the unit direction, black where the effects leave it out.
inline RgbD skyAlong(const Scene& scene, EffectSet effects, const Vec3d& direction) {
  if (!effects.has(Effect::sky) || direction == Vec3d()) return {};  // 0 sees nothing
  if (scene.sky.kind == Sky::Kind::image && !effects.has(Effect::skyImage)) return {};
  return skyRadiance(scene.sky, direction);
}

// Ambient light reflected by the diffuse color, of the part of the surface that is there, but black
// where that reflects the scene instead; and the blurred sky where the glossy lobe reflects it.
inline RgbD reflectedAmbient(const Scene& scene, EffectSet effects, const Surfel& surfel) {
  const Material& material = scene.materials[surfel.material];
  RgbD light;
  if (effects.has(Effect::ambient) && !material.diffuses(effects)) {
    const RgbD up(scene.ambient.up), down(scene.ambient.down);
    light = surfel.diffuse * (down + (up - down) * (0.5 + 0.5 * surfel.shadingNormal.y));
    light = light * surfel.occlusion;
  }
  if (!material.reflectsBlurredSky(effects) || scene.blurredSky.r.empty()) return light;
  const double cosine = dot(surfel.shadingNormal, surfel.view), roughness = std::sqrt(surfel.alpha);
  const Vec3d mirrored = normalized(surfel.shadingNormal * (2 * cosine) - surfel.view);
  const RgbD sky = blurredRadiance(scene.sky, scene.blurredSky, mirrored, roughness) *
                   (double{scene.ambient.reflection} * surfel.occlusion);
  const double blurred = 1 - mirroredShare(material, effects, surfel);
  return light + sky * surfel.lobe * (RgbD(1.0) - mirrorOf(material, effects, surfel)) * blurred;
}

// Emission, and ambient light in frames that do not test it for occlusion.
inline RgbD emittedAndAmbient(const Scene& scene, EffectSet effects, const Surfel& surfel) {
  RgbD radiance;
  if (effects.has(Effect::emission)) {
    radiance = RgbD(scene.materials[surfel.material].emission) * surfel.emission;
  }
  if (!isOccluded(scene.ambient, effects)) radiance += reflectedAmbient(scene, effects, surfel);
  return radiance * surfel.coverage;
}

// Returns the radiance that fog adds, divided by the share of light that it lets through, because
// the weight by which the result is multiplied contains that share.
inline RgbD fogBefore(const World& world, const Chunk& chunk, std::size_t slot) {
  if (!world.effects.has(Effect::fog) || rayOf(chunk, slot).direction == Vec3d()) return {};
  if (chunk.has(Feature::transmission) && chunk.rays.media[slot] != 0) return {};

  const bool hit = chunk.surfels.material[slot] != kMiss;
  const auto growth = [&](float sigma) {
    if (!(sigma > 0)) return 0.0;
    // Rounded as in kernels, because the exponential multiplies relative errors by the depth.
    const float depth = hit ? std::min(sigma * chunk.hits.t[slot], kOpaqueFog) : kOpaqueFog;
    return std::expm1(double{depth});
  };

  const Fog& fog = world.scene.fog;
  return RgbD(fog.color) *
         RgbD(growth(fog.density.x), growth(fog.density.y), growth(fog.density.z));
}

// The row that the steps write.
inline RadianceRow writeEmittedAndReflectiveAmbient(const World& world, const Chunk& chunk,
                                                    std::size_t slot) {
  RgbD radiance, clear;
  if (chunk.surfels.material[slot] == kMiss) {
    const bool isClear = chunk.has(Feature::alpha) && chunk.isStraight(slot);
    if (isClear) clear = RgbD(1.0);
    const bool hidesSky = isClear && chunk.options().background.hidesSky();
    if (!hidesSky) radiance = skyAlong(world.scene, world.effects, rayOf(chunk, slot).direction);
  } else if (!isHidden(chunk, slot)) {
    radiance = emittedAndAmbient(world.scene, world.effects, surfelOf(chunk, slot));
  }
  radiance += fogBefore(world, chunk, slot);
  RadianceRow row{radiance};
  row.clear = clear;
  return row;
}

}  // namespace whit::reference
