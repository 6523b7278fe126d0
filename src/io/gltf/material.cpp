#include "io/gltf/material.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/gltf/document.h"
#include "scene/material.h"

namespace whit {
namespace {

using Value = tinygltf::Value;

constexpr double kLargestEmission = 1e9;    // a factor and a strength of this are finite together
constexpr float kLeastAttenuation = 1e-6f;  // of a color; the logarithm is taken

Rgb colorOf(const Value& object, const char* key, const Rgb& fallback) {
  if (!object.Has(key)) return fallback;
  const Value& list = object.Get(key);
  const auto at = [&](int i) { return static_cast<float>(list.Get(i).GetNumberAsDouble()); };
  return {at(0), at(1), at(2)};
}

class GltfMaterialReader {
 public:
  GltfMaterialReader(const GltfDocument& document, const tinygltf::Material& source,
                     std::string where)
      : document_(document), source_(source) {
    m_.name = source.name;
    m_.doubleSided = source.doubleSided;
    m_.where = std::move(where);
  }

  GltfMaterial convert() {
    factors();
    maps();
    extensions();
    countCoordinatesLeftOut();
    countMapsLeftOut();
    return std::move(m_);
  }

 private:
  void warn(const char* what) { document_.warnings().add(what, m_.where); }

  const Value* named(const char* extension) const {
    return findExtension(source_.extensions, extension);
  }

  float unit(double x) {
    if (x >= 0 && x <= 1) return static_cast<float>(x);
    warn("material value clamped to [0, 1]");
    return x > 0 ? 1.0f : 0.0f;
  }
  float emission(double x) {
    if (x < 0) warn("negative emission taken as 0");
    return static_cast<float>(std::clamp(x, 0.0, kLargestEmission));
  }
  Rgb unit(const Rgb& c) { return {unit(c.x), unit(c.y), unit(c.z)}; }

  void factors() {
    const tinygltf::PbrMetallicRoughness& pbr = source_.pbrMetallicRoughness;
    const std::vector<double>& base = pbr.baseColorFactor;
    m_.base = {unit(base[0]), unit(base[1]), unit(base[2])};
    m_.alpha = unit(base[3]);
    m_.metallic = unit(pbr.metallicFactor);
    m_.roughness = unit(pbr.roughnessFactor);
    const std::vector<double>& e = source_.emissiveFactor;
    // Above 1 is a strength that some writers leave in.
    for (std::size_t i = 0; i < 3; ++i) {
      m_.emission[static_cast<int>(i)] = emission(e[i]);
    }
    if (source_.alphaMode == "MASK") m_.alphaMode = GltfMaterial::Alpha::mask;
    if (source_.alphaMode == "BLEND") m_.alphaMode = GltfMaterial::Alpha::blend;
    if (source_.alphaMode != "OPAQUE" && m_.alphaMode == GltfMaterial::Alpha::opaque) {
      warn("unknown alpha mode taken as OPAQUE");
    }
    m_.alphaCutoff = static_cast<float>(std::clamp(source_.alphaCutoff, 0.0, 2.0));
  }

  void maps() {
    const tinygltf::PbrMetallicRoughness& pbr = source_.pbrMetallicRoughness;
    m_.baseMap = texture(pbr.baseColorTexture);
    m_.unlit = named("KHR_materials_unlit") != nullptr;
    if (m_.unlit) {
      m_.metallic = 0;
      m_.emission = Rgb();
      return;
    }
    m_.metallicRoughnessMap = texture(pbr.metallicRoughnessTexture);
    m_.normalMap = texture(source_.normalTexture);
    m_.normalScale = static_cast<float>(std::clamp(source_.normalTexture.scale, -1e3, 1e3));
    m_.emissiveMap = texture(source_.emissiveTexture);
  }

  template <typename Info>
  GltfTexture texture(const Info& info) const {
    return readGltfTexture(document_, m_.where, info.index, info.texCoord, info.extensions);
  }
  // Of an extension.
  GltfTexture texture(const Value& extension, const char* slot) const {
    if (m_.unlit || !extension.Has(slot)) return {};
    return readGltfTexture(document_, m_.where, extension.Get(slot));
  }

  void countCoordinatesLeftOut() {
    const GltfMaterial::Coordinates known = m_.coordinates();
    const bool third = !(m_.emissiveMap.uv == known.first) && !(m_.emissiveMap.uv == known.second);
    if (m_.emitsByMap() && third) {
      warn("texture with a third kind of coordinates in its material: those of the first taken");
    }
    const auto apart = [&](const GltfTexture& map) {
      return map.exists() && !(map.uv == m_.surfaceMap().uv);
    };
    if (m_.variesRoughness() && m_.surfaceMap().exists() && apart(m_.metallicRoughnessMap)) {
      warn("roughness by a texture with other coordinates than the base color's: these taken");
    }
    if (m_.mixesMetal() && apart(m_.metallicRoughnessMap)) {
      warn("metalness by a texture with other coordinates than the base color's: these taken");
    }
    if (m_.variesF0() && (apart(m_.specularMap) || apart(m_.specularColorMap))) {
      warn("specular by a texture with other coordinates than the base color's: these taken");
    }
  }

  void extensions() {
    if (const Value* e = named("KHR_materials_ior")) ior(numberOf(*e, "ior", 1.5));
    const float step = (m_.ior - 1) / (m_.ior + 1);
    m_.specularColor = Rgb(step * step);
    if (const Value* e = named("KHR_materials_specular")) specular(*e);
    if (const Value* e = named("KHR_materials_emissive_strength")) {
      m_.emission *= emission(numberOf(*e, "emissiveStrength", 1));
    }
    if (const Value* e = named("KHR_materials_transmission")) transmission(*e);
    if (const Value* e = named("KHR_materials_volume")) volume(*e);
    if (const Value* e = named("KHR_materials_clearcoat")) {
      m_.clearcoat = unit(numberOf(*e, "clearcoatFactor", 0));
      m_.clearcoatRoughness = unit(numberOf(*e, "clearcoatRoughnessFactor", 0));
      m_.clearcoatMap = texture(*e, "clearcoatTexture");
      m_.clearcoatRoughnessMap = texture(*e, "clearcoatRoughnessTexture");
    }
  }

  void countMapsLeftOut() {
    constexpr struct {
      const char *extension, *map, *warning;
    } kMaps[] = {
        {"KHR_materials_clearcoat", "clearcoatNormalTexture", "normal map of a clearcoat left out"},
        {"KHR_materials_volume", "thicknessTexture",
         "thickness of a volume by a texture left out: what the mesh encloses counts"},
    };
    for (const auto& [extension, map, warning] : kMaps) {
      const Value* e = named(extension);
      if (e && e->Has(map)) warn(warning);
    }
  }

  void ior(double x) {
    if (!(x >= 1 && x <= kLargestIor)) warn("index of refraction clamped to [1, 10]");
    m_.ior = static_cast<float>(std::clamp(x, 1.0, static_cast<double>(kLargestIor)));
  }

  void specular(const Value& e) {
    m_.f90 = unit(numberOf(e, "specularFactor", 1));
    m_.specularColor = m_.specularColor * colorOf(e, "specularColorFactor", Rgb(1.0f));
    m_.specularMap = texture(e, "specularTexture");
    m_.specularColorMap = texture(e, "specularColorTexture");
  }

  void transmission(const Value& e) {
    m_.transmission = unit(numberOf(e, "transmissionFactor", 0));
    m_.transmissionMap = texture(e, "transmissionTexture");
  }

  void volume(const Value& e) {
    if (numberOf(e, "thicknessFactor", 0) < 0) warn("negative thickness of a volume left out");
    if (!e.Has("attenuationDistance")) return;  // infinite
    const double distance = numberOf(e, "attenuationDistance", 0);
    if (!(distance > 0)) return warn("attenuation distance that is not above 0 left out");
    const Rgb color = unit(colorOf(e, "attenuationColor", Rgb(1.0f)));
    for (int i = 0; i < 3; ++i) {
      const double kept = std::max(color[i], kLeastAttenuation);
      m_.absorption[i] = static_cast<float>(std::min(-std::log(kept) / distance, 1e18));
    }
  }

  const GltfDocument& document_;
  const tinygltf::Material& source_;
  GltfMaterial m_;
};

}  // namespace

const GltfTexture& GltfMaterial::surfaceMap() const {
  if (baseMap.exists()) return baseMap;
  if (mixesMetal()) return metallicRoughnessMap;
  return variesF0() && specularMap.exists() ? specularMap : variesF0() ? specularColorMap : baseMap;
}

GltfMaterial::Coordinates GltfMaterial::coordinates() const {
  Coordinates found;
  bool any = false;
  const auto add = [&](const GltfTexture& map, bool needed) {
    if (!needed || found.areTwo()) return;
    if (!any) found.first = map.uv;
    found.second = map.uv;
    any = true;
  };
  add(surfaceMap(), surfaceMap().exists());
  add(metallicRoughnessMap, !surfaceMap().exists() && variesRoughness());
  add(normalMap, normalMap.exists());
  add(emissiveMap, emitsByMap());
  return found;
}

std::vector<GltfMaterial> readGltfMaterials(const GltfDocument& document) {
  std::vector<GltfMaterial> materials;
  const std::vector<tinygltf::Material>& sources = document.model().materials;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    materials.push_back(
        GltfMaterialReader(document, sources[i], document.where("materials", i)).convert());
  }
  GltfMaterial fallback;
  fallback.name = "default";
  fallback.where = document.name();
  materials.push_back(fallback);
  return materials;
}

}  // namespace whit
