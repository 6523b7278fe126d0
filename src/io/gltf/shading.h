// A glTF material as a Material of this renderer. glTF 2.0 specification, appendix B;
// KHR_materials_*.
#pragma once

#include "core/vec3.h"
#include "io/gltf/material.h"
#include "scene/material.h"

namespace whit {

// The means of maps that the factors of a Material depend on.
struct GltfMeans {
  Rgb base{1, 1, 1};
  float metallic = 1, roughness = 1, transmission = 1;
  bool roughnessByMap = false;  // its texels differ and are multiplied with the factor
  float specular = 1;           // its strength
  Rgb specularColor{1, 1, 1};
  float clearcoat = 1, clearcoatRoughness = 1;
  float alpha = 1;          // of a texture that blends and is the same everywhere
  bool alphaByMap = false;  // its texels differ and are multiplied with the factor
};

// Below this a surface reflects the scene by a single impulse.
inline constexpr float kGltfSmoothRoughness = 0.25f;

// The Material, without its maps:
// - diffuse is the base color of what is neither metal nor transmission. Mirror and sampled lobes
//   reduce it by what they reflect (scene/material.h).
// - specular, the lobe that lights are seen in, is f0 = ((ior - 1) / (ior + 1))^2 or the base
//   color of metal, texel by texel, as are strength and color of KHR_materials_specular, and the
//   roughness.
// - Surfaces that are smooth on average also mirror the scene, from the mean of that to f90 at
//   grazing incidence. Rough ones reflect it in samples of the lobe, unless they bound a volume.
// - transmission bounds a dielectric of this ior (exact Fresnel reflectance), tinted by the base
//   color at each crossing, with the absorption of its volume; surfaces must be closed. It is
//   clear whatever the roughness, and a map of it counts by its mean.
// - blending lets 1 - alpha straight through, texel by texel; what blends is a sheet, whatever it
//   transmits besides.
// - a smooth clearcoat adds a mirror of 0.04 at normal incidence; maps of it count by their means.
// - unlit colors are emitted, and nothing else is.
// - single-sided surfaces are passed from behind by all rays but those of shadows, unless they
//   bound a volume.
// - vertex colors multiply the base color: diffuse, of what is mostly metal specular as well, but
//   no mirror; of unlit materials the emission.
Material shadedAs(const GltfMaterial& source, const GltfMeans& means);

}  // namespace whit
