// glTF's materials, as the file has them and as a Material of this renderer. glTF 2.0
// specification, sections 3.8 and 3.9 and appendix B; KHR_materials_*, KHR_texture_transform. MTL
// files are read into the same record.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/vec3.h"
#include "io/gltf/document.h"
#include "io/model.h"
#include "io/texture_loader.h"
#include "scene/material.h"
#include "scene/texture.h"

namespace whit {

// Which set of coordinates a texture is looked up with, and the affine map to apply to it: in the
// format's own sense, v pointing down.
struct GltfUvMap {
  std::size_t set = 0;
  double uu = 1, uv = 0, u0 = 0;  // u' = uu u + uv v + u0
  double vu = 0, vv = 1, v0 = 0;

  // Coordinates as a Mesh has them, v pointing up, from the file's own.
  Vec2f map(double u, double v) const {
    return {static_cast<float>(uu * u + uv * v + u0),
            static_cast<float>(1 - (vu * u + vv * v + v0))};
  }
  bool operator==(const GltfUvMap&) const = default;
};

struct GltfTexture {
  std::optional<std::size_t> image;
  Wrap wrapU = Wrap::repeat, wrapV = Wrap::repeat;
  bool nearest = false;  // magnified without interpolation
  GltfUvMap uv;
  bool exists() const { return image.has_value(); }
};

// A material as the file has it.
struct GltfMaterial {
  enum class Alpha { opaque, mask, blend };
  std::string name, where;
  Rgb base{1, 1, 1};
  float alpha = 1, metallic = 1, roughness = 1;
  Rgb specularColor{0.04f, 0.04f, 0.04f};  // F0 of what is no metal: from the ior, times a factor
  float f90 = 1;                           // its reflectance at grazing incidence
  bool grazingFades = false;  // set for MTL: below 4 % at normal incidence, f90 is less
  Rgb emission{0, 0, 0};
  Alpha alphaMode = Alpha::opaque;
  float alphaCutoff = 0.5f;
  float transmission = 0, ior = 1.5f;
  float thickness = 0;  // thickness of the volume; 0: the surface is a thin wall
  Rgb absorption{0, 0, 0};
  float clearcoat = 0, clearcoatRoughness = 0;
  bool unlit = false, doubleSided = false;
  GltfTexture baseMap, metallicRoughnessMap, normalMap, emissiveMap, occlusionMap;
  GltfTexture roughnessMap;                   // glTF has it in metallicRoughnessMap, MTL apart
  GltfTexture maskMap;                        // MTL only: counts in place of the base color's alpha
  GltfTexture specularMap, specularColorMap;  // strength in alpha, color
  GltfTexture transmissionMap, clearcoatMap, clearcoatRoughnessMap;
  float normalScale = 1, occlusionStrength = 1;
  // The alpha of vertex colors counts. Without maps u is alphaRampU() of it, and beside maps the
  // second coordinates have it (Material::alphaByVertex).
  bool alphaByVertex = false;
  bool mirrorIsApart = false;        // set for MTL: no reflectance at normal incidence
  bool normalsMayBeHeights = false;  // set for MTL: a gray normalMap holds heights
  bool maskMayBlend = false;         // set for MTL: a mask that is mostly gray is coverage

  // The coordinates of the maps that are looked up texel by texel: those of the first map, and the
  // first ones that differ from them (or the same again if none differ).
  struct Coordinates {
    GltfUvMap first, second;
    bool areTwo() const { return !(first == second); }
    bool bySecond(const GltfTexture& map) const { return areTwo() && map.uv == second; }
    bool operator==(const Coordinates&) const = default;
  };
  Coordinates coordinates() const;
  // True if the maps of diffuse and specular reflectance depend on the metalness of each texel.
  bool mixesMetal() const {
    return metallic > 0 && (metallicRoughnessMap.exists() || (baseMap.exists() && metallic < 1));
  }
  // Returns the reflectance at normal incidence of what is no metal, where maps have these values.
  Rgb f0(const Rgb& color, float strength) const {
    return min(max(specularColor * color, Rgb(0.0f)), Rgb(1.0f)) * (f90 * strength);
  }
  bool variesF0() const {
    return (specularMap.exists() || specularColorMap.exists()) && metallic < 1 &&
           maxComponent(f0(Rgb(1.0f), 1)) > 0;
  }
  // True if the map of specular reflectance holds all of it.
  bool bakesSpecular() const { return mixesMetal() || variesF0(); }
  // Returns the texture whose coordinates diffuse and specular reflectance are looked up with. It
  // does not exist if there is no such map.
  const GltfTexture& surfaceMap() const;
  // True if a texture of its own varies the transmission.
  bool variesTransmission() const { return transmission > 0 && transmissionMap.exists(); }
  // True if the transmission needs a map: of that texture, the base color's or the metalness.
  bool bakesTransmission() const {
    return variesTransmission() || (transmission > 0 && (baseMap.exists() || mixesMetal()));
  }
  // True if a map may multiply the mirror's reflectance. A clearcoat adds its reflection to that of
  // the base, and no map fits both.
  bool mirrorsByMap() const { return clearcoat == 0 && !mirrorIsApart; }
  bool variesRoughness() const { return roughnessMap.exists() && roughness > 0; }
  bool isMapped() const {
    return surfaceMap().exists() || variesRoughness() || normalMap.exists() || emitsByMap() ||
           occlusionMap.exists();
  }
  bool emitsByMap() const { return emissiveMap.exists() && maxComponent(emission) > 0; }
  bool multipliesAlpha() const { return alphaByVertex && isMapped(); }
};

// Alpha is looked up in a texture of two texels, between whose centers it rises evenly from 0 to 1.
inline float alphaRampU(float alpha) { return 0.25f + 0.5f * std::clamp(alpha, 0.0f, 1.0f); }

// Reads all materials of the document, and adds the format's default as the last one. Properties
// that cannot be represented are counted in the document's warnings.
std::vector<GltfMaterial> readGltfMaterials(const GltfDocument& document);

// The means of maps that the factors of a Material depend on.
struct GltfMeans {
  Rgb base{1, 1, 1};
  float metallic = 1, roughness = 1;
  bool roughnessByMap = false;  // its texels differ and are multiplied with the factor
  float specular = 1;           // its strength
  Rgb specularColor{1, 1, 1};
  float clearcoat = 1, clearcoatRoughness = 1;
  float alpha = 1;          // alpha of a texture that blends and is the same everywhere
  bool alphaByMap = false;  // its texels differ and are multiplied with the factor
  bool maskBlends = false;  // the mask is mostly gray (maskMayBlend)
};

// How often an image repeats where the coordinates that look it up grow by 1, and where it begins.
struct Repeats {
  double u = 1, v = 1, u0 = 0, v0 = 0;
  bool isColor = false;  // its texels are interpolated in linear light
  bool operator==(const Repeats&) const = default;
};
// Returns how to resample a texture of the material for the coordinates that it is looked up with,
// because other textures already take both sets. None if its own are turned, of another set, or not
// finite, or if the image does not repeat, or no whole number of times.
std::optional<Repeats> repeatsOf(const GltfMaterial& material, const GltfTexture& texture);
// Returns true if a map that the material needs can neither be looked up with its own coordinates
// nor be resampled.
bool lacksCoordinates(const GltfMaterial& material);

// Returns the Material, without its maps:
// - diffuse is the base color of what is neither metal nor transmission. Clearcoat and lobe reduce
//   it by what they reflect (scene/material.h).
// - specular, the lobe, is f0 = ((ior - 1) / (ior + 1))^2 or the base color of metal, texel by
//   texel, as are strength and color of KHR_materials_specular, and the roughness. It reflects
//   lights and the scene, but where the surface bounds a volume: there it shows lights, the
//   dielectric adds its own reflection, and smooth metal that of a mirror.
// - transmission is tinted by the base color at each crossing. With a volume of some thickness the
//   surface bounds a dielectric of this ior (exact Fresnel reflectance) and absorption, and must be
//   closed; without one it is a thin wall. It is frosted by its roughness.
// - blending lets 1 - alpha straight through, texel by texel; what blends is a sheet, whatever it
//   transmits besides.
// - a clearcoat is a mirror of 0.04 at normal incidence over the rest, as far as it is smooth; maps
//   of it count by their means.
// - unlit colors are emitted, and nothing else is.
// - single-sided surfaces are passed from behind by all rays but those of shadows, unless they
//   bound a volume.
// - vertex colors multiply the base color: diffuse and transmission, of what is mostly metal
//   specular and mirror as well; of unlit materials the emission.
Material shadedAs(const GltfMaterial& source, const GltfMeans& means);

// An image of the document. It is decoded when it is needed, and freed when nobody holds it.
class GltfImage;

struct GltfMaps {
  Material slots;                          // only its maps are set, to slots of a TextureLoader
  std::shared_ptr<const GltfMeans> means;  // filled in when the textures are decoded
};

// Makes a Material with factors that depend on what images hold.
using GltfShading = std::function<Material(const GltfMeans& means)>;

class GltfMapMaker {
 public:
  // Materials refer to `images` by their indices.
  GltfMapMaker(const std::vector<GltfImageSource>& images, Warnings& warnings);

  // Returns `material` with slots for the maps of `source` that are not `given`. When the textures
  // are decoded, its other members that are not given become those of `shading`. An image that
  // cannot be read is a warning, and white. This and the images outlive the textures' decoding.
  TexturedMaterial withMaps(const GltfMaterial& source, Material material,
                            const GivenMembers& given, TextureLoader& textures,
                            GltfShading shading);

 private:
  // Returns the slots of a material's maps. Materials with the same maps share slots.
  GltfMaps request(const GltfMaterial& material, TextureLoader& textures);

  Warnings& warnings_;
  std::vector<std::shared_ptr<GltfImage>> images_;
  std::map<std::string, GltfMaps> known_;
};

}  // namespace whit
