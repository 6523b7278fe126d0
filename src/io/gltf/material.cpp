#include "io/gltf/material.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/gltf/document.h"
#include "scene/material.h"

namespace whit {
namespace {

constexpr double kLargestEmission = 1e9;    // a factor and a strength of this are finite together
constexpr float kLeastAttenuation = 1e-6f;  // of a color; the logarithm is taken

Rgb colorOf(const GltfValue& color, const Rgb& fallback) {
  const std::vector<double> c = color.numbers(3);
  if (c.empty()) return fallback;
  return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
}

class GltfMaterialReader {
 public:
  GltfMaterialReader(const GltfDocument& document, const GltfValue& source)
      : document_(document), source_(source) {
    m_.name = source["name"].text();
    m_.doubleSided = source["doubleSided"].flag();
    m_.where = source.where();
  }

  GltfMaterial convert() {
    factors();
    maps();
    extensions();
    countCoordinatesLeftOut();
    return std::move(m_);
  }

 private:
  void warn(const char* what) { document_.warnings().add(what, m_.where); }

  GltfValue extension(const char* name) const { return source_["extensions"][name]; }

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
    const GltfValue pbr = source_["pbrMetallicRoughness"];
    std::vector<double> base = pbr["baseColorFactor"].numbers(4);
    if (base.empty()) base = {1, 1, 1, 1};
    m_.base = {unit(base[0]), unit(base[1]), unit(base[2])};
    m_.alpha = unit(base[3]);
    m_.metallic = unit(pbr["metallicFactor"].number(1));
    m_.roughness = unit(pbr["roughnessFactor"].number(1));
    const std::vector<double> e = source_["emissiveFactor"].numbers(3);
    // Some writers store a strength above 1 here.
    for (std::size_t i = 0; i < e.size(); ++i) m_.emission[static_cast<int>(i)] = emission(e[i]);
    const std::string alphaMode = source_["alphaMode"].text("OPAQUE");
    if (alphaMode == "MASK") m_.alphaMode = GltfMaterial::Alpha::mask;
    if (alphaMode == "BLEND") m_.alphaMode = GltfMaterial::Alpha::blend;
    if (alphaMode != "OPAQUE" && m_.alphaMode == GltfMaterial::Alpha::opaque) {
      warn("unknown alpha mode taken as OPAQUE");
    }
    m_.alphaCutoff = static_cast<float>(std::clamp(source_["alphaCutoff"].number(0.5), 0.0, 2.0));
  }

  void maps() {
    const GltfValue pbr = source_["pbrMetallicRoughness"], normal = source_["normalTexture"];
    m_.baseMap = texture(pbr["baseColorTexture"]);
    m_.unlit = extension("KHR_materials_unlit").exists();
    if (m_.unlit) {
      m_.metallic = 0;
      m_.emission = Rgb();
      return;
    }
    m_.metallicRoughnessMap = texture(pbr["metallicRoughnessTexture"]);
    m_.normalMap = texture(normal);
    m_.normalScale = static_cast<float>(std::clamp(normal["scale"].number(1), -1e3, 1e3));
    m_.emissiveMap = texture(source_["emissiveTexture"]);
  }

  GltfTexture texture(const GltfValue& info) const {
    return readGltfTexture(document_, m_.where, info);
  }
  GltfTexture extensionTexture(const GltfValue& info) const {
    return m_.unlit ? GltfTexture() : texture(info);
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
    ior(extension("KHR_materials_ior")["ior"].number(1.5));
    const float step = (m_.ior - 1) / (m_.ior + 1);
    m_.specularColor = Rgb(step * step);
    specular(extension("KHR_materials_specular"));
    m_.emission *=
        emission(extension("KHR_materials_emissive_strength")["emissiveStrength"].number(1));
    const GltfValue transmission = extension("KHR_materials_transmission");
    m_.transmission = unit(transmission["transmissionFactor"].number(0));
    m_.transmissionMap = extensionTexture(transmission["transmissionTexture"]);
    volume(extension("KHR_materials_volume"));
    const GltfValue coat = extension("KHR_materials_clearcoat");
    m_.clearcoat = unit(coat["clearcoatFactor"].number(0));
    m_.clearcoatRoughness = unit(coat["clearcoatRoughnessFactor"].number(0));
    m_.clearcoatMap = extensionTexture(coat["clearcoatTexture"]);
    m_.clearcoatRoughnessMap = extensionTexture(coat["clearcoatRoughnessTexture"]);
    if (coat["clearcoatNormalTexture"].exists()) warn("normal map of a clearcoat left out");
  }

  void ior(double x) {
    if (!(x >= 1 && x <= kLargestIor)) warn("index of refraction clamped to [1, 10]");
    m_.ior = static_cast<float>(std::clamp(x, 1.0, static_cast<double>(kLargestIor)));
  }

  void specular(const GltfValue& e) {
    m_.f90 = unit(e["specularFactor"].number(1));
    m_.specularColor = m_.specularColor * colorOf(e["specularColorFactor"], Rgb(1.0f));
    m_.specularMap = extensionTexture(e["specularTexture"]);
    m_.specularColorMap = extensionTexture(e["specularColorTexture"]);
  }

  void volume(const GltfValue& e) {
    if (e["thicknessTexture"].exists()) {
      warn("thickness of a volume by a texture left out: what the mesh encloses counts");
    }
    if (e["thicknessFactor"].number(0) < 0) warn("negative thickness of a volume left out");
    if (!e["attenuationDistance"].exists()) return;  // infinite
    const double distance = e["attenuationDistance"].number(0);
    if (!(distance > 0)) return warn("attenuation distance that is not above 0 left out");
    const Rgb color = unit(colorOf(e["attenuationColor"], Rgb(1.0f)));
    for (int i = 0; i < 3; ++i) {
      const double kept = std::max(color[i], kLeastAttenuation);
      m_.absorption[i] = static_cast<float>(std::min(-std::log(kept) / distance, 1e18));
    }
  }

  const GltfDocument& document_;
  GltfValue source_;
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
  const GltfValue sources = document.list("materials");
  for (std::size_t i = 0; i < sources.size(); ++i) {
    materials.push_back(GltfMaterialReader(document, sources[i]).convert());
  }
  GltfMaterial fallback;
  fallback.name = "default";
  fallback.where = document.name();
  materials.push_back(fallback);
  return materials;
}

}  // namespace whit
