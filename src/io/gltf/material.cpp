#include "io/gltf/material.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "io/gltf/document.h"
#include "scene/material.h"

namespace whit {
namespace {

Wrap readWrap(const JsonValue& code) {
  constexpr std::uint64_t kRepeat = 10497, kClampToEdge = 33071, kMirroredRepeat = 33648;
  const std::uint64_t found = code.wholeOr(kRepeat);
  return found == kClampToEdge      ? Wrap::clamp
         : found == kMirroredRepeat ? Wrap::mirror
                                    : Wrap::repeat;
}

std::size_t readSet(const JsonValue& texCoord, std::size_t fallback) {
  constexpr std::uint64_t kLargestSet = 1000;
  return texCoord.wholeOr(fallback, kLargestSet);
}

// KHR_texture_transform: translation * rotation * scale; with v pointing down, counter-clockwise as
// seen.
void readUvTransform(const JsonValue& t, GltfUvMap& uv) {
  const double r = t["rotation"].numberOr(0), c = std::cos(r), s = std::sin(r);
  std::vector<double> scale = t["scale"].numbers(2), offset = t["offset"].numbers(2);
  if (scale.empty()) scale = {1, 1};
  if (offset.empty()) offset = {0, 0};
  uv.uu = c * scale[0];
  uv.uv = s * scale[1];
  uv.u0 = offset[0];
  uv.vu = -s * scale[0];
  uv.vv = c * scale[1];
  uv.v0 = offset[1];
  uv.set = readSet(t["texCoord"], uv.set);
}

// Reads a reference to a texture; none where `info` does not exist.
GltfTexture readTexture(const GltfDocument& document, const std::string& where,
                        const JsonValue& info) {
  GltfTexture result;
  if (!info.exists()) return result;
  const JsonValue textures = document.list("textures"), samplers = document.list("samplers");
  const JsonValue texture = textures[info.need("index").indexInto(textures).value_or(0)];
  result.image = texture["source"].indexInto(document.list("images"));
  if (!result.image) {
    document.warnings().add("texture in a format that is not supported left out", where);
    return result;
  }
  if (const auto index = texture["sampler"].indexInto(samplers)) {
    const JsonValue sampler = samplers[*index];
    result.wrapU = readWrap(sampler["wrapS"]);
    result.wrapV = readWrap(sampler["wrapT"]);
    constexpr std::uint64_t kNearest = 9728;
    if (sampler["magFilter"].wholeOr(0) == kNearest) {
      document.warnings().add("texture to be looked up at its nearest texel, interpolated instead",
                              where);
    }
  }
  result.uv.set = readSet(info["texCoord"], 0);
  const JsonValue transform = info["extensions"]["KHR_texture_transform"];
  if (transform.exists()) readUvTransform(transform, result.uv);
  return result;
}

constexpr double kLargestEmission = 1e9;    // a factor and a strength of this are finite together
constexpr float kLeastAttenuation = 1e-6f;  // of a color; the logarithm is taken

Rgb colorOf(const JsonValue& color, const Rgb& fallback) {
  const std::vector<double> c = color.numbers(3);
  if (c.empty()) return fallback;
  return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
}

class GltfMaterialReader {
 public:
  GltfMaterialReader(const GltfDocument& document, const JsonValue& source)
      : document_(document), source_(source) {
    m_.name = source["name"].textOr("");
    m_.doubleSided = source["doubleSided"].flagOr(false);
    m_.where = source.where();
  }

  GltfMaterial read() {
    factors();
    maps();
    extensions();
    countCoordinatesLeftOut();
    return std::move(m_);
  }

 private:
  void warn(const char* what) { document_.warnings().add(what, m_.where); }

  JsonValue extension(const char* name) const { return source_["extensions"][name]; }

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
    const JsonValue pbr = source_["pbrMetallicRoughness"];
    std::vector<double> base = pbr["baseColorFactor"].numbers(4);
    if (base.empty()) base = {1, 1, 1, 1};
    m_.base = {unit(base[0]), unit(base[1]), unit(base[2])};
    m_.alpha = unit(base[3]);
    m_.metallic = unit(pbr["metallicFactor"].numberOr(1));
    m_.roughness = unit(pbr["roughnessFactor"].numberOr(1));
    const std::vector<double> e = source_["emissiveFactor"].numbers(3);
    // Some writers store a strength above 1 here.
    for (std::size_t i = 0; i < e.size(); ++i) m_.emission[static_cast<int>(i)] = emission(e[i]);
    const std::string alphaMode = source_["alphaMode"].textOr("OPAQUE");
    if (alphaMode == "MASK") m_.alphaMode = GltfMaterial::Alpha::mask;
    if (alphaMode == "BLEND") m_.alphaMode = GltfMaterial::Alpha::blend;
    if (alphaMode != "OPAQUE" && m_.alphaMode == GltfMaterial::Alpha::opaque) {
      warn("unknown alpha mode taken as OPAQUE");
    }
    m_.alphaCutoff = static_cast<float>(std::clamp(source_["alphaCutoff"].numberOr(0.5), 0.0, 2.0));
  }

  void maps() {
    const JsonValue pbr = source_["pbrMetallicRoughness"], normal = source_["normalTexture"];
    m_.baseMap = texture(pbr["baseColorTexture"]);
    m_.unlit = extension("KHR_materials_unlit").exists();
    if (m_.unlit) {
      m_.metallic = 0;
      m_.emission = Rgb();
      return;
    }
    m_.metallicRoughnessMap = texture(pbr["metallicRoughnessTexture"]);
    m_.normalMap = texture(normal);
    m_.normalScale = static_cast<float>(std::clamp(normal["scale"].numberOr(1), -1e3, 1e3));
    m_.emissiveMap = texture(source_["emissiveTexture"]);
  }

  GltfTexture texture(const JsonValue& info) const {
    return readTexture(document_, m_.where, info);
  }
  GltfTexture extensionTexture(const JsonValue& info) const {
    return m_.unlit ? GltfTexture() : texture(info);
  }

  void countCoordinatesLeftOut() {
    const GltfMaterial::Coordinates known = m_.coordinates();
    const bool third = !(m_.emissiveMap.uv == known.first) && !(m_.emissiveMap.uv == known.second);
    if (m_.emitsByMap() && third) {
      warn("texture with a third kind of coordinates in its material: those of the first taken");
    }
    const auto warnIfApart = [&](bool matters, const GltfTexture& map, const char* warning) {
      if (matters && map.exists() && !(map.uv == m_.surfaceMap().uv)) warn(warning);
    };
    warnIfApart(m_.variesRoughness() && m_.surfaceMap().exists(), m_.metallicRoughnessMap,
                "roughness by a texture with other coordinates than the base color's: these taken");
    warnIfApart(m_.mixesMetal(), m_.metallicRoughnessMap,
                "metalness by a texture with other coordinates than the base color's: these taken");
    const bool strength = m_.specularMap.exists() && !(m_.specularMap.uv == m_.surfaceMap().uv);
    warnIfApart(m_.variesF0(), strength ? m_.specularMap : m_.specularColorMap,
                "specular by a texture with other coordinates than the base color's: these taken");
  }

  void extensions() {
    ior(extension("KHR_materials_ior")["ior"].numberOr(1.5));
    const float step = (m_.ior - 1) / (m_.ior + 1);
    m_.specularColor = Rgb(step * step);
    specular(extension("KHR_materials_specular"));
    m_.emission *=
        emission(extension("KHR_materials_emissive_strength")["emissiveStrength"].numberOr(1));
    const JsonValue transmission = extension("KHR_materials_transmission");
    m_.transmission = unit(transmission["transmissionFactor"].numberOr(0));
    m_.transmissionMap = extensionTexture(transmission["transmissionTexture"]);
    volume(extension("KHR_materials_volume"));
    const JsonValue coat = extension("KHR_materials_clearcoat");
    m_.clearcoat = unit(coat["clearcoatFactor"].numberOr(0));
    m_.clearcoatRoughness = unit(coat["clearcoatRoughnessFactor"].numberOr(0));
    m_.clearcoatMap = extensionTexture(coat["clearcoatTexture"]);
    m_.clearcoatRoughnessMap = extensionTexture(coat["clearcoatRoughnessTexture"]);
    if (coat["clearcoatNormalTexture"].exists()) warn("normal map of a clearcoat left out");
  }

  void ior(double x) {
    if (!(x >= 1 && x <= kLargestIor)) warn("index of refraction clamped to [1, 10]");
    m_.ior = static_cast<float>(std::clamp(x, 1.0, static_cast<double>(kLargestIor)));
  }

  void specular(const JsonValue& e) {
    m_.f90 = unit(e["specularFactor"].numberOr(1));
    m_.specularColor = m_.specularColor * colorOf(e["specularColorFactor"], Rgb(1.0f));
    m_.specularMap = extensionTexture(e["specularTexture"]);
    m_.specularColorMap = extensionTexture(e["specularColorTexture"]);
  }

  void volume(const JsonValue& e) {
    if (e["thicknessTexture"].exists()) {
      warn("thickness of a volume by a texture left out: what the mesh encloses counts");
    }
    if (e["thicknessFactor"].numberOr(0) < 0) warn("negative thickness of a volume left out");
    if (!e["attenuationDistance"].exists()) return;  // infinite
    const double distance = e["attenuationDistance"].numberOr(0);
    if (!(distance > 0)) return warn("attenuation distance that is not above 0 left out");
    const Rgb color = unit(colorOf(e["attenuationColor"], Rgb(1.0f)));
    for (int i = 0; i < 3; ++i) {
      const double kept = std::max(color[i], kLeastAttenuation);
      m_.absorption[i] = static_cast<float>(std::min(-std::log(kept) / distance, 1e18));
    }
  }

  const GltfDocument& document_;
  JsonValue source_;
  GltfMaterial m_;
};

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
  const JsonValue sources = document.list("materials");
  for (std::size_t i = 0; i < sources.size(); ++i) {
    materials.push_back(GltfMaterialReader(document, sources[i]).read());
  }
  GltfMaterial fallback;
  fallback.name = "default";
  fallback.where = document.name();
  materials.push_back(fallback);
  return materials;
}

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
