#include "io/gltf_shading.h"

#include <algorithm>
#include <utility>

namespace whit {
namespace {

// A mask that cuts everything, with or without a map.
Material invisible(Material m) {
  m.diffuse = m.emission = Rgb(0.0f);
  m.transmission = Rgb(1.0f);
  m.ior = 1;
  m.castsShadow = false;
  return m;
}

// Emits its color, and lets the rest straight through.
Material unlit(Material m, const Rgb& base, float coverage) {
  m.diffuse = Rgb(0.0f);
  m.emission = base * coverage;
  m.vertexTint = VertexTint::emission;
  m.transmission = Rgb(1 - coverage);
  if (coverage < 1) m.ior = 1;
  m.castsShadow = !m.hasTransmission();
  return m;
}

Rgb mix(const Rgb& a, const Rgb& b, float t) { return a * (1 - t) + b * t; }

}  // namespace

Material shadedAs(const GltfMaterial& g, const GltfMeans& means) {
  Material m;
  m.name = g.name;
  m.doubleSided = g.doubleSided;
  const float roughness = g.roughness * means.roughness;
  m.roughness = means.roughnessByMap ? g.roughness : roughness;
  m.emission = g.emission;
  const GltfMaterial::Coordinates coordinates = g.coordinates();
  m.normalBySecondUvs = coordinates.bySecond(g.normalMap);
  m.emissionBySecondUvs = coordinates.bySecond(g.emissiveMap);
  m.alphaCutoff = g.alphaMode == GltfMaterial::Alpha::mask && g.alpha > 0
                      ? std::min(g.alphaCutoff / g.alpha, 1.0f)
                      : 0.5f;
  if (g.alphaMode == GltfMaterial::Alpha::mask && g.alpha < g.alphaCutoff) {
    return invisible(std::move(m));
  }
  const bool blends = g.alphaMode == GltfMaterial::Alpha::blend;
  const float coverage = blends ? g.alpha * means.alpha : 1.0f;
  if (g.unlit) return unlit(std::move(m), g.base, coverage);
  const Rgb base = g.base * means.base;
  const Rgb f0 = g.f0(means.specularColor, means.specular);
  const float f90 = g.f90 * means.specular;
  const float metal = g.metallic * means.metallic;
  const float clear = g.transmission * means.transmission;
  if (metal >= 0.5f) m.vertexTint = VertexTint::diffuseAndSpecular;
  m.diffuse = g.base * ((g.mixesMetal() ? 1 : 1 - metal) * (1 - clear) * coverage);
  m.specular = (g.bakesSpecular() ? Rgb(1.0f) : mix(f0, g.base, metal)) * coverage;
  const float through = clear * (1 - metal);
  m.transmission = base * (through * coverage) + Rgb(1 - coverage);
  if (through > 0) {
    m.ior = g.ior;
    m.absorption = g.absorption;
  } else if (coverage < 1) {
    m.ior = 1;
  }
  m.glossyReflection = roughness > kGltfSmoothRoughness && !m.hasTransmission();
  if (roughness <= kGltfSmoothRoughness) {
    // The dielectric adds its own reflectance.
    const float share = through > 0 ? metal : 1.0f;
    m.mirror = mix(f0, base, metal) * (share * coverage);
    m.mirrorGrazing = Rgb((f90 * (1 - metal) + metal) * share * coverage);
  }
  if (g.clearcoatRoughness * means.clearcoatRoughness <= kGltfSmoothRoughness) {
    const float coat = g.clearcoat * means.clearcoat;
    m.mirror = min(m.mirror + Rgb(0.04f * coat), Rgb(1.0f));
    m.mirrorGrazing = max(m.mirrorGrazing, Rgb(coat));
  }
  m.castsShadow = !m.hasTransmission();
  return m;
}

}  // namespace whit
