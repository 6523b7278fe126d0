#include "io/gltf/shading.h"

#include <algorithm>
#include <utility>

namespace whit {
namespace {

// Emits its color.
Material unlit(Material m, const Rgb& base) {
  m.diffuse = Rgb(0.0f);
  m.emission = base;
  m.vertexTint = VertexTint::emission;
  m.castsShadow = m.blocksLight();
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
  if (g.alphaMode == GltfMaterial::Alpha::blend) {
    m.coverage = g.alpha * means.alpha;
    m.thin = means.alphaByMap;
    if (means.alphaByMap) m.alphaCutoff = kClearCoverage;
  }
  // A mask that cuts everything, with or without a map.
  if (g.alphaMode == GltfMaterial::Alpha::mask && g.alpha < g.alphaCutoff) m.coverage = 0;
  if (g.unlit) return unlit(std::move(m), g.base);
  const Rgb base = g.base * means.base;
  const Rgb f0 = g.f0(means.specularColor, means.specular);
  const float f90 = g.f90 * means.specular;
  const float metal = g.metallic * means.metallic;
  const float clear = g.transmission * means.transmission;
  if (metal >= 0.5f) m.vertexTint = VertexTint::diffuseAndSpecular;
  m.diffuse = g.base * ((g.mixesMetal() ? 1 : 1 - metal) * (1 - clear));
  m.specular = g.bakesSpecular() ? Rgb(1.0f) : mix(f0, g.base, metal);
  m.transmission = base * (clear * (1 - metal));
  if (m.boundsMedium()) {
    m.ior = g.ior;
    m.absorption = g.absorption;
  }
  m.glossyReflection = roughness > kGltfSmoothRoughness && !m.boundsMedium();
  if (roughness <= kGltfSmoothRoughness) {
    // The dielectric adds its own reflectance.
    const float share = m.boundsMedium() ? metal : 1.0f;
    m.mirror = mix(f0, base, metal) * share;
    m.mirrorGrazing = Rgb((f90 * (1 - metal) + metal) * share);
  }
  if (g.clearcoatRoughness * means.clearcoatRoughness <= kGltfSmoothRoughness) {
    const float coat = g.clearcoat * means.clearcoat;
    m.mirror = min(m.mirror + Rgb(0.04f * coat), Rgb(1.0f));
    m.mirrorGrazing = max(m.mirrorGrazing, Rgb(coat));
  }
  m.castsShadow = m.blocksLight();
  return m;
}

}  // namespace whit
