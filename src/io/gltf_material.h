// glTF's materials, and what they become here. glTF 2.0 specification, section 3.9 and appendix B;
// KHR_materials_*, KHR_texture_transform.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/vec3.h"
#include "io/gltf_document.h"
#include "scene/material.h"
#include "scene/texture.h"

namespace whit {

// Which set of coordinates a texture is looked up with, and the affine map to apply to it: in the
// format's own sense, v pointing down.
struct GltfUvMap {
  std::size_t set = 0;
  double uu = 1, uv = 0, u0 = 0;  // u' = uu u + uv v + u0
  double vu = 0, vv = 1, v0 = 0;
  bool operator==(const GltfUvMap&) const = default;
};

struct GltfTexture {
  int image = -1;  // none
  Wrap wrapU = Wrap::repeat, wrapV = Wrap::repeat;
  GltfUvMap uv;
  bool exists() const { return image >= 0; }
};

// A material as the file has it.
struct GltfMaterial {
  enum class Alpha { opaque, mask, blend };
  std::string name, where;
  Rgb base{1, 1, 1};
  float alpha = 1, metallic = 1, roughness = 1;
  Rgb f0{0.04f, 0.04f, 0.04f};  // reflectance of what is no metal, at normal incidence
  float f90 = 1;                // and at grazing incidence
  Rgb emission{0, 0, 0};
  Alpha alphaMode = Alpha::opaque;
  float alphaCutoff = 0.5f;
  float transmission = 0, ior = 1.5f;
  Rgb absorption{0, 0, 0};
  float clearcoat = 0, clearcoatRoughness = 0;
  bool unlit = false;
  GltfTexture baseMap, metallicRoughnessMap, normalMap, emissiveMap, transmissionMap;
  float normalScale = 1;

  // The coordinates of the maps that it needs texel by texel: those of the first there is, and the
  // first that differ from them (equal where none do).
  struct Coordinates {
    GltfUvMap first, second;
    bool areTwo() const { return !(first == second); }
    bool bySecond(const GltfTexture& map) const { return areTwo() && map.uv == second; }
  };
  Coordinates coordinates() const;
  // Whether the maps of diffuse and specular reflectance depend on the metalness of each texel.
  bool mixesMetal() const {
    return metallic > 0 && (metallicRoughnessMap.exists() || (baseMap.exists() && metallic < 1));
  }
  // Whose coordinates those maps have.
  const GltfTexture& surfaceMap() const {
    return baseMap.exists() || !mixesMetal() ? baseMap : metallicRoughnessMap;
  }
  bool emitsByMap() const { return emissiveMap.exists() && maxComponent(emission) > 0; }
};

// One for each material, and the format's default last. What cannot be represented is counted in
// the document's warnings.
std::vector<GltfMaterial> readGltfMaterials(const GltfDocument& document);

// What maps hold on average, as far as the factors of a Material depend on it.
struct GltfMeans {
  Rgb base{1, 1, 1};
  float metallic = 1, roughness = 1, transmission = 1;
  float alpha = 1;  // of a texture that blends evenly; 1 where it cuts
};

// Below this a surface reflects the scene by a single impulse.
inline constexpr float kGltfSmoothRoughness = 0.25f;

// The Material, without its maps:
// - diffuse is the base colour of what is neither metal nor transmission. It is not reduced by what
//   the surface reflects specularly.
// - specular, the lobe that lights are seen in, is f0 = ((ior - 1) / (ior + 1))^2 or the base
//   colour of metal, texel by texel. The roughness is the mean of its map.
// - Smooth surfaces also mirror the scene, from the mean of that to f90 at grazing incidence. Rough
//   ones reflect it in samples of the lobe, unless they transmit.
// - transmission bounds a dielectric of this ior (exact Fresnel reflectance), tinted by the base
//   colour at each crossing, with the absorption of its volume; surfaces must be closed. It is
//   clear whatever the roughness, and a map of it counts by its mean.
// - blending lets 1 - alpha straight through, by the mean of a map that has mostly intermediate
//   values; other maps cut at 1/2.
// - a smooth clearcoat adds a mirror of 0.04 at normal incidence.
// - unlit colours are emitted, and nothing else is.
// - vertex colours multiply the base colour: diffuse, of what is mostly metal specular as well, but
//   no mirror; of unlit materials the emission.
Material shadedAs(const GltfMaterial& source, const GltfMeans& means);

}  // namespace whit
