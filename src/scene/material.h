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
// With the mirror's weight m, Fresnel's reflectance F of the interface (0 of what is no dielectric)
// and the albedo A of the glossy lobe towards the viewer, the layers share the light from the top:
//   reflectance = m + (1 - m) * F
//   glossy lobe = (1 - m) * (1 - F) * A
//   transmittance = (1 - F) * (1 - A) * t
//   diffuse = (1 - F) * (1 - A) * d
// Mirror and colors add up as far as there is light for them:
//   t = transmission * min(1, (1 - m) / largest channel of the transmission)
//   d = diffuse color * min(1, (1 - m - t) / largest channel of the diffuse color)
// Coats, as the mirrors of models are, leave (1 - m) * transmission and (1 - m) * diffuse color
// instead (glTF 2.0 specification, appendix B: mix(base, layer, F)), and 1 - m of the light of
// lamps that the lobe below reflects. The shares depend on the view and on no light, so that light
// is linear, and their sum is at most 1 at every angle. Where rays sample the lobe (--glossy), A is
// the mean weight of the very samples that are taken, whose expected value is the lobe's albedo; so
// the sum is 1 for every number of samples where nothing absorbs. Otherwise A is the albedo by a
// table (sampling/ggx_lobe.h), and the scene that the lobe reflects is the mirrored ray's if the
// lobe is smooth, the sky blurred by roughness if it is rough, and a mixture of both between. A
// lobe in whose place mirror or interface reflect the scene shows lights only, as their highlight,
// and takes nothing from the others.
//
// Rays that sample lobes sample frosted glass, too. The facets of a frosted dielectric are its
// interface: each reflects F and transmits 1 - F of its own angle (Walter et al. 2007), so that the
// mean weight A of the reflected samples stands for F. Those of a frosted sheet transmit what they
// do not reflect, in the mean straight on: the direction that they mirror, mirrored once more at
// the sheet.
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
// The name of the material that darkens the ground below a model (make/ground_shadow.h). It says
// nothing about how bright the model is.
inline constexpr const char* kGroundShadowName = "ground shadow";

// Vertex colors multiply the base color, which a metal has in `specular` and `mirror` too, and
// glass in `transmission`.
enum class VertexTint : std::uint8_t { diffuse, diffuseAndSpecular, emission };

inline constexpr float kMinRoughness = 0.03f;
// The default of Material::grazingRatio. With it, the grazing reflectance of a lobe is below 1 if
// its reflectance is below 4 %, that of a common dielectric, and a lobe of 0 reflects nothing.
inline constexpr float kGrazingRatio = 25;
// A lobe of no more than this alpha reflects the scene by a single impulse: it is about as wide as
// a pixel, 0.002 radians to either side.
inline constexpr float kSmoothAlpha = 1e-3f;
// A lobe that is not sampled reflects the scene along the mirrored ray up to the first roughness,
// the blurred sky from the second one on, and in between a mixture, so that neither begins with a
// jump.
inline constexpr float kMirroredRoughness = 0.05f, kBlurredRoughness = 0.3f;
// The share of the mirrored ray.
inline double mirroredShareOf(double roughness) {
  constexpr double kEnd = kBlurredRoughness, kBegin = kMirroredRoughness;
  return std::clamp((kEnd - roughness) / (kEnd - kBegin), 0.0, 1.0);
}

// Members are listed in scene/members.h.
struct Material {
  std::string name;

  Rgb diffuse{0.8f, 0.8f, 0.8f};         // albedo, times diffuseMap
  std::int32_t diffuseMap = kNoTexture;  // color
  // The diffuse color reflects the scene under --indirect, not only lights and ambient light.
  bool diffuseReflection = true;
  Rgb specular{0, 0, 0};                  // glossy lobe's reflectance at normal incidence (F0)
  std::int32_t specularMap = kNoTexture;  // color, multiplies `specular`
  // The lobe's reflectance at grazing incidence over that at normal incidence; at most 1 is
  // reflected.
  float grazingRatio = kGrazingRatio;
  float roughness = 0.5f;                  // GGX; alpha = roughness^2, at least kMinRoughness
  std::int32_t roughnessMap = kNoTexture;  // data, channel g; multiplies `roughness`
  // The lobe reflects the scene, not only lights. It is false where the reflection is a mirrored
  // impulse already. Frames take --glossy samples of it.
  bool glossyReflection = true;
  Rgb emission{0, 0, 0};                  // radiance, both sides, times emissionMap
  std::int32_t emissionMap = kNoTexture;  // color, or radiance where it goes beyond 1
  std::int32_t normalMap = kNoTexture;    // data, tangent space, +y up
  // The map multiplies indirect light, as if nearby geometry occluded the rest. It does not affect
  // lights.
  std::int32_t occlusionMap = kNoTexture;  // data, channel r
  // These maps are looked up with Mesh::secondUvs.
  bool emissionBySecondUvs = false, normalBySecondUvs = false, occlusionBySecondUvs = false;
  // The alpha of vertices multiplies alphaMap and coverageMap. Mesh::secondUvs have what the alpha
  // lacks of 1 as their u, so that meshes without them are opaque; no map is looked up with them.
  bool alphaByVertex = false;
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
  // The mirror is a coat: layers below it get only the light that it does not reflect. Without it,
  // mirror and lower layers share the light only where their sum would exceed 1. A mirror in a
  // scene file is a coat only if the file states so.
  bool coat = false;

  // Refracted impulse, when `transmission` is above zero: the surface bounds a dielectric, or is a
  // sheet so thin that light goes straight on.
  Rgb transmission{0, 0, 0};
  std::int32_t transmissionMap = kNoTexture;  // color
  bool thin = false;
  bool frosted = false;  // facets of `roughness` scatter what passes, in frames that sample lobes
  float ior = 1.5f;
  Rgb absorption{0, 0, 0};  // per unit length, inside
  int priority = 0;         // where dielectrics overlap, the highest wins

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
  bool hasFacets() const { return hasGlossy() || (frosted && hasTransmission()); }
  bool variesRoughness() const { return hasFacets() && roughnessMap != kNoTexture; }
  bool hasGlossyReflection() const { return hasGlossy() && glossyReflection; }
  bool hasDiffuseReflection() const { return maxComponent(diffuse) > 0 && diffuseReflection; }
  // In frames with these effects the diffuse color reflects the scene in place of ambient light.
  bool diffuses(EffectSet effects) const {
    return effects.has(Effect::indirect) && hasDiffuseReflection();
  }
  // It is frosted and rough, at least somewhere.
  bool isFrosted() const {
    const bool isRough = roughness * roughness > kSmoothAlpha || roughnessMap != kNoTexture;
    return frosted && hasTransmission() && isRough;
  }
  // In frames with these effects rays sample what frosted glass transmits.
  bool frosts(EffectSet effects) const {
    return effects.has(Effect::glossyReflection) && effects.has(Effect::transmission) &&
           isFrosted();
  }
  // In frames with these effects the facets of the interface reflect in place of a lobe.
  bool hasFrostedInterface(EffectSet effects) const { return frosts(effects) && boundsMedium(); }
  // In frames with these effects the lobe takes light from what lies below it.
  bool dimsBelow(EffectSet effects) const {
    const bool isHighlight = !glossyReflection && (hasMirror() || hasTransmission());
    return (effects.has(Effect::glossy) && hasGlossy() && !isHighlight) ||
           hasFrostedInterface(effects);
  }
  // In frames with these effects lamps reach the lobe through a coat.
  bool isUnderCoat(EffectSet effects) const {
    return coat && effects.has(Effect::mirror) && hasMirror() && dimsBelow(effects) &&
           !hasFrostedInterface(effects);
  }
  // In frames with these effects the lobe reflects the blurred sky.
  bool reflectsBlurredSky(EffectSet effects) const {
    return effects.has(Effect::blurredSky) && hasGlossyReflection();
  }
  // The lobe is so smooth, somewhere, that a mirrored ray stands for it unless rays sample it.
  bool isSmooth() const {
    return hasGlossyReflection() && (roughness < kBlurredRoughness || variesRoughness());
  }
  bool mirrorsByLobe(EffectSet effects) const {
    return effects.has(Effect::mirror) && effects.has(Effect::glossy) &&
           !effects.has(Effect::glossyReflection) && isSmooth();
  }
  // In frames with these effects rays sample the lobe.
  bool scatters(EffectSet effects) const {
    return (effects.has(Effect::glossyReflection) && hasGlossyReflection()) ||
           hasFrostedInterface(effects);
  }
  // Mirror, lobe or transmission may leave less light than those below them ask for, and so may the
  // interface of glass that a sheet lies on.
  bool isLayered(EffectSet effects) const {
    const float most = std::max(maxComponent(mirror), maxComponent(mirrorGrazing));
    const float color = maxComponent(diffuse);
    const bool limits = most > 0 && (coat || most + color > 1);
    const bool onGlass = isPartlyThere() && effects.has(Effect::mirror);
    return dimsBelow(effects) || (color > 0 && (hasTransmission() || onGlass || limits));
  }
  bool hasMirror() const { return maxComponent(mirror) > 0 || maxComponent(mirrorGrazing) > 0; }
  bool hasTransmission() const { return maxComponent(transmission) > 0; }
  // In frames with these effects the weight of the mirrored ray differs from hit to hit.
  bool variesMirror(EffectSet effects) const {
    const bool tinted = vertexTint == VertexTint::diffuseAndSpecular && !coat;
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
  void passClearTexels() {
    alphaMap = coverageMap;
    alphaCutoff = kClearCoverage;
  }
  // Default of castsShadow.
  bool blocksLight() const { return !hasTransmission() && coverage >= 0.5f; }
};

}  // namespace whit
