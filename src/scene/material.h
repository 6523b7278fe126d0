// Reflection, transmission and emission of surfaces. One record serves all materials: an effect
// that a material does not have is a zero, and a surface may have several at once (a diffuse floor
// with a mirror coat, glass that both reflects and refracts).
//
// Colors are multiplied by their maps and, as `vertexTint` says, by the colors of the mesh's
// vertices; a mirror's at normal incidence only. Radiance leaving towards the viewer, with n the
// shading normal (Whitted 1980, with physical units):
//   emission
//   + diffuse * ambient(n)
//   or, under --indirect, + diffuse * mean of radiance along rays drawn by the cosine to n (where
//   diffuseReflection)
//   + sum over lights of (diffuse / pi + glossy lobe) * biradiance * max(0, n.l)
//   + reflectance * radiance along the mirrored ray
//   + mean of radiance along rays that sample the glossy lobe (where glossyReflection)
//   + transmittance * radiance along the refracted ray
// Ambient light, the blurred sky, and the rays of lobes at the first hit count by `occlusionMap`.
// All of that counts by the share of the surface that is there (`coverage`); through the rest light
// goes straight on, as glTF's and most other formats' alpha has it (Porter and Duff 1984).
// With the mirror's weight m and Fresnel's reflectance F of the interface (0 of what is no
// dielectric),
//   reflectance = m + (1 - m) * F
//   transmittance = (1 - F) * transmission * min(1, (1 - m) / largest channel of the transmission)
// so that they never make light: the mirror comes first, and what it leaves is all that passes. The
// diffuse color gets the rest: with t the part of the transmission that passes, it is multiplied by
//   (1 - F) * min(1, (1 - m - t) / largest channel of the diffuse color).
// A glossy lobe that rays sample (--glossy) lies between the mirror and the others: its samples
// count (1 - F) * (1 - m), and transmission and diffuse color count 1 - G besides (glTF 2.0
// specification, appendix B: mix(diffuse, specular, F)). G is the mean weight of the very samples
// that are taken, whose expected value is the lobe's albedo towards the viewer; so the sum is at
// most 1 at every angle and for every number of samples, and 1 where nothing absorbs. A lobe that
// is not sampled shows lights, and in place of the scene a blurred sky: with S the sky as a lobe of
// its roughness sees it along the mirrored view and A the lobe's albedo, A * S is added, and 1 - A
// is what transmission and diffuse color count.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "core/effects.h"
#include "core/vec3.h"

namespace whit {

inline constexpr std::int32_t kNoTexture = -1;

inline constexpr double kLeastIor = 0.1;
inline constexpr float kLargestIor = 10;

inline constexpr float kClearCoverage = 1.0f / 1024;  // less counts as clear

// The name of the material of meshes that have none in their file.
inline constexpr const char* kNoMaterialName = "default";

// Vertex colors multiply the base color, which a metal has in `specular` and `mirror` too, and
// glass in `transmission`.
enum class VertexTint : std::uint8_t { diffuse, diffuseAndSpecular, emission };

// Members are listed in scene/members.h.
struct Material {
  std::string name;

  Rgb diffuse{0.8f, 0.8f, 0.8f};         // albedo, times diffuseMap
  std::int32_t diffuseMap = kNoTexture;  // color
  // The diffuse color reflects the scene under --indirect, not only lights and ambient light.
  bool diffuseReflection = true;
  Rgb specular{0, 0, 0};                   // glossy lobe's reflectance at normal incidence (F0)
  std::int32_t specularMap = kNoTexture;   // color, multiplies `specular`
  float roughness = 0.5f;                  // GGX; alpha = roughness^2, at least kMinRoughness
  std::int32_t roughnessMap = kNoTexture;  // data, channel g; multiplies `roughness`
  // The lobe reflects the scene, not only lights. It is false where the reflection is a mirrored
  // impulse already. Frames take --glossy samples of it.
  bool glossyReflection = true;
  Rgb emission{0, 0, 0};                  // radiance, both sides, times emissionMap
  std::int32_t emissionMap = kNoTexture;  // color, or radiance where it goes beyond 1
  std::int32_t normalMap = kNoTexture;    // data, tangent space, +y up
  // Indirect light counts times this map, as if something nearby held the rest off. Lights do not.
  std::int32_t occlusionMap = kNoTexture;  // data, channel r
  // These maps are looked up with Mesh::secondUvs.
  bool emissionBySecondUvs = false, normalBySecondUvs = false, occlusionBySecondUvs = false;
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
  std::int32_t mirrorMap = kNoTexture;  // color, multiplies `mirror`
  Rgb mirrorGrazing{0, 0, 0};

  // Refracted impulse, when `transmission` is above zero: the surface bounds a dielectric, or is a
  // sheet so thin that light goes straight on.
  Rgb transmission{0, 0, 0};
  std::int32_t transmissionMap = kNoTexture;  // color
  bool thin = false;
  float ior = 1.5f;
  Rgb absorption{0, 0, 0};  // per unit length, inside
  int priority = 0;         // of nested dielectrics: the highest wins where they overlap

  VertexTint vertexTint = VertexTint::diffuse;
  // False: rays of the eye and impulses pass its back faces; shadows are cast by both sides.
  bool doubleSided = true;
  bool castsShadow = true;  // false: light passes, as if the surface were not there

  // Place of these members in the scene's description (JSON pointer, RFC 6901), or empty.
  std::string pointer;

  std::array<std::int32_t, 10> maps() const {
    return {diffuseMap, specularMap, roughnessMap, emissionMap, normalMap,
            alphaMap,   coverageMap, occlusionMap, mirrorMap,   transmissionMap};
  }
  bool hasGlossy() const { return maxComponent(specular) > 0; }
  bool variesRoughness() const { return hasGlossy() && roughnessMap != kNoTexture; }
  bool hasGlossyReflection() const { return hasGlossy() && glossyReflection; }
  bool hasDiffuseReflection() const { return maxComponent(diffuse) > 0 && diffuseReflection; }
  // In frames with these effects the diffuse color reflects the scene in place of ambient light.
  bool diffuses(EffectSet effects) const {
    return effects.has(Effect::indirect) && hasDiffuseReflection();
  }
  // In frames with these effects the lobe reflects the blurred sky.
  bool reflectsBlurredSky(EffectSet effects) const {
    return effects.has(Effect::blurredSky) && hasGlossyReflection() && !hasMirror();
  }
  // In frames with these effects the lobe is sampled, and takes light from what lies below it.
  bool scatters(EffectSet effects) const {
    return effects.has(Effect::glossyReflection) && hasGlossyReflection();
  }
  // Mirror, lobe or transmission may leave less light than the diffuse color asks for.
  bool limitsDiffuse(EffectSet effects) const {
    const float coat = std::max(maxComponent(mirror), maxComponent(mirrorGrazing));
    const float color = maxComponent(diffuse);
    return color > 0 && (hasTransmission() || scatters(effects) || reflectsBlurredSky(effects) ||
                         (coat > 0 && coat + color > 1));
  }
  bool hasMirror() const { return maxComponent(mirror) > 0 || maxComponent(mirrorGrazing) > 0; }
  bool hasTransmission() const { return maxComponent(transmission) > 0; }
  // In frames with these effects the weight of the mirrored ray differs from hit to hit.
  bool variesMirror(EffectSet effects) const {
    const bool tinted = vertexTint == VertexTint::diffuseAndSpecular;
    return hasMirror() && ((effects.has(Effect::textures) && mirrorMap != kNoTexture) ||
                           (effects.has(Effect::vertexColors) && tinted));
  }
  // Likewise that of the refracted ray.
  bool variesTransmission(EffectSet effects) const {
    const bool tinted = vertexTint != VertexTint::emission;
    return hasTransmission() && ((effects.has(Effect::textures) && transmissionMap != kNoTexture) ||
                                 (effects.has(Effect::vertexColors) && tinted));
  }
  bool isPartlyThere() const { return coverage < 1 || coverageMap != kNoTexture; }
  bool passesLight() const { return hasTransmission() || isPartlyThere(); }
  // Another medium begins behind the surface. A surface that is partly there is a sheet.
  bool boundsMedium() const { return hasTransmission() && !thin && !isPartlyThere(); }
  bool hasAbsorption() const { return boundsMedium() && maxComponent(absorption) > 0; }
  // A surface that is cut by its own coverage has holes where it is clear, and casts shadows where
  // it covers half.
  bool isCutByCoverage() const { return alphaMap != kNoTexture && alphaMap == coverageMap; }
  float shadowCutoff() const {
    return isCutByCoverage() ? std::clamp(0.5f / coverage, alphaCutoff, 1.0f) : alphaCutoff;
  }
  // A surface that is cut by another map casts shadows where its coverage is at least half, too.
  bool isCutBesidesCoverage() const {
    return coverageMap != kNoTexture && alphaMap != kNoTexture && alphaMap != coverageMap;
  }
  float coverageCutoff() const { return std::min(0.5f / coverage, 1.0f); }
  // Rays pass clear texels without a bounce.
  void cutWhereClear() {
    alphaMap = coverageMap;
    alphaCutoff = kClearCoverage;
  }
  // Default of castsShadow.
  bool blocksLight() const { return !hasTransmission() && coverage >= 0.5f; }
};

inline constexpr float kMinRoughness = 0.03f;
// A lobe of no more than this alpha reflects the scene by a single impulse.
inline constexpr float kSmoothAlpha = 1e-3f;

}  // namespace whit
