// What a surface does with light. One record for every kind of material: an effect that a material
// does not have is a zero, and a surface may have several at once (a diffuse floor with a mirror
// coat, glass that both reflects and refracts).
//
// Diffuse, specular and emission are multiplied by their maps and, as `vertexTint` says, by the
// colors of the mesh's vertices. Radiance leaving towards the viewer, with n the shading normal
// (Whitted 1980, with physical units):
//   emission
//   + diffuse * ambient(n)
//   or, under --indirect, + diffuse * mean of radiance along rays drawn by the cosine to n (where
//   diffuseReflection)
//   + sum over lights of (diffuse / pi + glossy lobe) * biradiance * max(0, n.l)
//   + reflectance * radiance along the mirrored ray
//   + mean of radiance along rays that sample the glossy lobe (where glossyReflection)
//   + transmittance * radiance along the refracted ray
// All of that counts by the share of the surface that is there (`coverage`); through the rest light
// goes straight on, as glTF's and most other formats' alpha has it (Porter and Duff 1984).
// With the mirror's weight m and Fresnel's reflectance F of the interface (0 of what is no
// dielectric),
//   reflectance = m + (1 - m) * F
//   transmittance = (1 - F) * transmission * min(1, (1 - m) / largest channel of the transmission)
// so that they never make light: the mirror comes first, and what it leaves is all that passes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <tuple>

#include "core/effects.h"
#include "core/vec3.h"

namespace whit {

inline constexpr std::int32_t kNoTexture = -1;

inline constexpr float kLargestIor = 10;  // that a file can ask for

inline constexpr float kClearCoverage = 1.0f / 1024;  // less is none

// What the colors of vertices multiply: the base color, wherever that went.
enum class VertexTint : std::uint8_t { diffuse, diffuseAndSpecular, emission };

struct Material {
  std::string name;

  Rgb diffuse{0.8f, 0.8f, 0.8f};         // albedo, times diffuseMap
  std::int32_t diffuseMap = kNoTexture;  // color
  // Whether it reflects the scene under --indirect, not only lights and ambient light.
  bool diffuseReflection = true;
  Rgb specular{0, 0, 0};                   // glossy lobe's reflectance at normal incidence (F0)
  std::int32_t specularMap = kNoTexture;   // color, multiplies `specular`
  float roughness = 0.5f;                  // GGX; alpha = roughness^2, at least kMinRoughness
  std::int32_t roughnessMap = kNoTexture;  // data, channel g; multiplies `roughness`
  // Whether the lobe reflects the scene, not only lights: for surfaces whose reflection is not
  // already a mirrored impulse. Frames take --glossy samples of it.
  bool glossyReflection = true;
  Rgb emission{0, 0, 0};                  // radiance, both sides, times emissionMap
  std::int32_t emissionMap = kNoTexture;  // color, or radiance where it goes beyond 1
  std::int32_t normalMap = kNoTexture;    // data, tangent space, +y up
  // Whether these two are looked up with Mesh::secondUvs.
  bool emissionBySecondUvs = false, normalBySecondUvs = false;
  std::int32_t alphaMap = kNoTexture;  // data, channel r; cut where below alphaCutoff
  float alphaCutoff = 0.5f;
  // The share of the surface that is there, times coverageMap (data, channel r). Shadows are cast
  // by what covers half or more.
  float coverage = 1;
  std::int32_t coverageMap = kNoTexture;

  // Reflected impulse. The weight goes from `mirror` at normal incidence to `mirrorGrazing` at
  // grazing incidence with Schlick's (1 - cos)^5. A dielectric (transmission above zero) reflects
  // by its exact Fresnel reflectance besides.
  Rgb mirror{0, 0, 0};
  Rgb mirrorGrazing{0, 0, 0};

  // Refracted impulse, when `transmission` is above zero: the surface bounds a dielectric, or is a
  // sheet so thin that light goes straight on.
  Rgb transmission{0, 0, 0};
  bool thin = false;
  float ior = 1.5f;
  Rgb absorption{0, 0, 0};  // per unit length, inside
  int priority = 0;         // of nested dielectrics: the highest wins where they overlap

  VertexTint vertexTint = VertexTint::diffuse;
  // False: rays of the eye and impulses pass its back faces; shadows are cast by both sides.
  bool doubleSided = true;
  bool castsShadow = true;  // false: light passes, as if the surface were not there

  // Where a scene's description has or can have these members (JSON pointer, RFC 6901); empty:
  // nowhere.
  std::string pointer;

  bool hasGlossy() const { return maxComponent(specular) > 0; }
  bool variesRoughness() const { return hasGlossy() && roughnessMap != kNoTexture; }
  bool hasGlossyReflection() const { return hasGlossy() && glossyReflection; }
  bool hasDiffuseReflection() const { return maxComponent(diffuse) > 0 && diffuseReflection; }
  // Whether in frames with these effects its diffuse color reflects the scene, in place of ambient
  // light.
  bool diffuses(EffectSet effects) const {
    return effects.has(Effect::indirect) && hasDiffuseReflection();
  }
  bool hasMirror() const { return maxComponent(mirror) > 0 || maxComponent(mirrorGrazing) > 0; }
  bool hasTransmission() const { return maxComponent(transmission) > 0; }
  bool isPartlyThere() const { return coverage < 1 || coverageMap != kNoTexture; }
  bool passesLight() const { return hasTransmission() || isPartlyThere(); }
  // Whether another medium begins behind it. What is there in part is a sheet.
  bool boundsMedium() const { return hasTransmission() && !thin && !isPartlyThere(); }
  bool hasAbsorption() const { return boundsMedium() && maxComponent(absorption) > 0; }
  // What is cut by its own coverage has holes where it is clear, and casts shadows where it covers
  // half.
  bool isCutByCoverage() const { return alphaMap != kNoTexture && alphaMap == coverageMap; }
  float shadowCutoff() const {
    return isCutByCoverage() ? std::clamp(0.5f / coverage, alphaCutoff, 1.0f) : alphaCutoff;
  }
  // Of one that is cut by another map, shadows are cast where its coverage is half as well.
  bool isCutBesidesCoverage() const {
    return coverageMap != kNoTexture && alphaMap != kNoTexture && alphaMap != coverageMap;
  }
  float coverageCutoff() const { return std::min(0.5f / coverage, 1.0f); }
  // Rays pass clear texels without a bounce.
  void cutWhereClear() {
    alphaMap = coverageMap;
    alphaCutoff = kClearCoverage;
  }
  // Where nothing else is said.
  bool blocksLight() const { return !hasTransmission() && coverage >= 0.5f; }
  // What --cutoff counts of the weights of the impulses that start here: 1, or less where they can
  // add up to more than 1 (a glossy lobe on glass). So a pixel's paths never count for more than 1
  // together, and a cutoff c leaves 1/c of them at most, whatever the materials and the depth;
  // times the number of samples where a lobe is sampled several times.
  float impulseShare(EffectSet effects) const;
};

// All of it that pictures depend on. The bindings name every member: one that is added does not
// compile before it is among them.
inline auto contentsOf(const Material& material) {
  const auto& [name, diffuse, diffuseMap, diffuseReflection, specular, specularMap, roughness,
               roughnessMap, glossyReflection, emission, emissionMap, normalMap,
               emissionBySecondUvs, normalBySecondUvs, alphaMap, alphaCutoff, coverage, coverageMap,
               mirror, mirrorGrazing, transmission, thin, ior, absorption, priority, vertexTint,
               doubleSided, castsShadow, pointer] = material;
  return std::tie(diffuse, diffuseMap, specular, specularMap, roughness, roughnessMap,
                  diffuseReflection, glossyReflection, emission, emissionMap, normalMap,
                  emissionBySecondUvs, normalBySecondUvs, coverage, coverageMap, thin, alphaMap,
                  alphaCutoff, mirror, mirrorGrazing, transmission, ior, absorption, priority,
                  vertexTint, doubleSided, castsShadow);
}

inline float Material::impulseShare(EffectSet effects) const {
  const float coat = std::max(maxComponent(mirror), maxComponent(mirrorGrazing));
  // What is not mirrored is refracted.
  const float both = hasTransmission() ? std::max(1.0f, coat) : coat;
  const float lobe = hasGlossyReflection() ? 1.0f : 0.0f;
  const float scattered = diffuses(effects) ? maxComponent(diffuse) : 0.0f;
  return 1 / std::max(1.0f, both + lobe + scattered);
}

inline constexpr float kMinRoughness = 0.03f;
// A lobe of no more than this alpha reflects the scene by a single impulse.
inline constexpr float kSmoothAlpha = 1e-3f;

}  // namespace whit
