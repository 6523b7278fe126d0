// glTF's materials. glTF 2.0 specification, section 3.9; KHR_materials_*.
#pragma once

#include <string>
#include <vector>

#include "core/vec3.h"
#include "io/gltf/document.h"
#include "io/gltf/texture.h"

namespace whit {

// A material as the file has it.
struct GltfMaterial {
  enum class Alpha { opaque, mask, blend };
  std::string name, where;
  Rgb base{1, 1, 1};
  float alpha = 1, metallic = 1, roughness = 1;
  Rgb specularColor{0.04f, 0.04f, 0.04f};  // of what is no metal: its ior's, times a factor
  float f90 = 1;                           // its reflectance at grazing incidence
  Rgb emission{0, 0, 0};
  Alpha alphaMode = Alpha::opaque;
  float alphaCutoff = 0.5f;
  float transmission = 0, ior = 1.5f;
  Rgb absorption{0, 0, 0};
  float clearcoat = 0, clearcoatRoughness = 0;
  bool unlit = false, doubleSided = false;
  GltfTexture baseMap, metallicRoughnessMap, normalMap, emissiveMap;
  GltfTexture specularMap, specularColorMap;  // strength in alpha, color
  GltfTexture transmissionMap, clearcoatMap, clearcoatRoughnessMap;
  float normalScale = 1;

  // The coordinates of the maps that it needs texel by texel: those of the first there is, and the
  // first that differ from them (equal where none do).
  struct Coordinates {
    GltfUvMap first, second;
    bool areTwo() const { return !(first == second); }
    bool bySecond(const GltfTexture& map) const { return areTwo() && map.uv == second; }
  };
  Coordinates coordinates() const;
  // True if the maps of diffuse and specular reflectance depend on the metalness of each texel.
  bool mixesMetal() const {
    return metallic > 0 && (metallicRoughnessMap.exists() || (baseMap.exists() && metallic < 1));
  }
  // The reflectance at normal incidence of what is no metal, where maps have these values.
  Rgb f0(const Rgb& color, float strength) const {
    return min(max(specularColor * color, Rgb(0.0f)), Rgb(1.0f)) * (f90 * strength);
  }
  bool variesF0() const {
    return (specularMap.exists() || specularColorMap.exists()) && metallic < 1 &&
           maxComponent(f0(Rgb(1.0f), 1)) > 0;
  }
  // True if the map of specular reflectance holds all of it.
  bool bakesSpecular() const { return mixesMetal() || variesF0(); }
  // Whose coordinates diffuse and specular reflectance are looked up with; none: there is no map.
  const GltfTexture& surfaceMap() const;
  bool variesRoughness() const { return metallicRoughnessMap.exists() && roughness > 0; }
  bool emitsByMap() const { return emissiveMap.exists() && maxComponent(emission) > 0; }
};

// One for each material, and the format's default last. What cannot be represented is counted in
// the document's warnings.
std::vector<GltfMaterial> readGltfMaterials(const GltfDocument& document);

}  // namespace whit
