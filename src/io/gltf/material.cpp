#include "io/gltf/material.h"

#include <cmath>
#include <cstdint>

#include "scene/members.h"

namespace whit {
namespace {

Wrap readWrap(const JsonValue& code) {
  constexpr std::uint64_t kRepeat = 10497, kClampToEdge = 33071, kMirroredRepeat = 33648;
  const std::uint64_t found = code.wholeOr(kRepeat);
  if (found == kClampToEdge) return Wrap::clamp;
  return found == kMirroredRepeat ? Wrap::mirror : Wrap::repeat;
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

// Reads a reference to a texture. The result does not exist if `info` does not.
GltfTexture readTexture(const GltfDocument& document, const std::string& where,
                        const JsonValue& info) {
  GltfTexture result;
  if (!info.exists()) return result;

  // The image of the texture, or its WebP version if this build reads that.
  const JsonValue textures = document.list("textures"), samplers = document.list("samplers");
  const JsonValue texture = textures[info.need("index").indexInto(textures).value_or(0)];
  const JsonValue webp = texture["extensions"]["EXT_texture_webp"]["source"];
  const JsonValue source = webp && document.reads("EXT_texture_webp") ? webp : texture["source"];
  result.image = source.indexInto(document.list("images"));
  if (!result.image) {
    document.warnings().add("texture in a format that is not supported left out", where);
    return result;
  }

  if (const auto index = texture["sampler"].indexInto(samplers)) {
    const JsonValue sampler = samplers[*index];
    result.wrapU = readWrap(sampler["wrapS"]);
    result.wrapV = readWrap(sampler["wrapT"]);
    constexpr std::uint64_t kNearest = 9728;
    result.nearest = sampler["magFilter"].wholeOr(0) == kNearest;
  }

  result.uv.set = readSet(info["texCoord"], 0);
  const JsonValue transform = info["extensions"]["KHR_texture_transform"];
  if (transform.exists()) readUvTransform(transform, result.uv);
  return result;
}

constexpr double kLargestEmission = 1e9;    // a factor and a strength of this are finite together
constexpr float kLeastAttenuation = 1e-6f;  // lower bound of colors, whose logarithm is taken

// Numbers are clamped, because some writers round them out of range.
float readNumber(const JsonValue& json, double fallback, double low = 0, double high = 1) {
  return static_cast<float>(std::clamp(json.numberOr(fallback), low, high));
}

Rgb colorOf(const std::vector<double>& c, double high = 1) {
  const auto clamped = [&](double x) { return static_cast<float>(std::clamp(x, 0.0, high)); };
  if (c.empty()) return Rgb(1.0f);
  return {clamped(c[0]), clamped(c[1]), clamped(c[2])};
}

// Reads one material of the file. The members of glTF and its extensions have the factors that the
// specifications state as defaults.
class GltfMaterialReader {
 public:
  GltfMaterialReader(const GltfDocument& document, const JsonValue& source)
      : document_(document), source_(source), extensions_(source["extensions"]) {}

  GltfMaterial read() {
    m_.name = source_["name"].textOr("");
    m_.where = source_.where();
    m_.doubleSided = source_["doubleSided"].flagOr(false);
    m_.unlit = extensions_["KHR_materials_unlit"].exists();

    readBase();
    readNormalAndOcclusion();
    readEmission();
    readAlphaMode();
    readDielectric();
    readVolume();
    readClearcoat();
    return m_;
  }

 private:
  void warnIf(bool isTrue, const char* what) const {
    if (isTrue) document_.warnings().add(what, m_.where);
  }
  // Unlit materials have no maps besides that of their color.
  GltfTexture texture(const JsonValue& info) const {
    if (m_.unlit) return GltfTexture();
    return readTexture(document_, m_.where, info);
  }

  void readBase() {
    const JsonValue pbr = source_["pbrMetallicRoughness"];
    const std::vector<double> base = pbr["baseColorFactor"].numbers(4);
    m_.base = colorOf(base);
    m_.alpha = base.empty() ? 1 : static_cast<float>(std::clamp(base[3], 0.0, 1.0));
    m_.baseMap = readTexture(document_, m_.where, pbr["baseColorTexture"]);

    m_.metallic = m_.unlit ? 0 : readNumber(pbr["metallicFactor"], 1);
    m_.roughness = readNumber(pbr["roughnessFactor"], 1);
    m_.metallicRoughnessMap = texture(pbr["metallicRoughnessTexture"]);
    m_.roughnessMap = m_.metallicRoughnessMap;
  }

  void readNormalAndOcclusion() {
    const JsonValue normal = source_["normalTexture"], occlusion = source_["occlusionTexture"];
    m_.normalMap = texture(normal);
    m_.normalScale = readNumber(normal["scale"], 1, -1e3, 1e3);
    m_.occlusionMap = texture(occlusion);
    m_.occlusionStrength = readNumber(occlusion["strength"], 1);
  }

  // Some writers store a strength above 1 in the factor.
  void readEmission() {
    const JsonValue emission = source_["emissiveFactor"];
    if (emission.exists() && !m_.unlit) {
      const JsonValue strength = extensions_["KHR_materials_emissive_strength"]["emissiveStrength"];
      m_.emission = colorOf(emission.numbers(3), kLargestEmission) *
                    readNumber(strength, 1, 0, kLargestEmission);
    }
    m_.emissiveMap = texture(source_["emissiveTexture"]);
  }

  void readAlphaMode() {
    using Alpha = GltfMaterial::Alpha;
    const std::string mode = source_["alphaMode"].textOr("OPAQUE");
    if (mode == "MASK") m_.alphaMode = Alpha::mask;
    if (mode == "BLEND") m_.alphaMode = Alpha::blend;
    warnIf(mode != "OPAQUE" && m_.alphaMode == Alpha::opaque, "unknown alpha mode taken as OPAQUE");
    m_.alphaCutoff = readNumber(source_["alphaCutoff"], 0.5, 0, 2);
  }

  // Reads the reflectance of what is no metal: that of its index of refraction, times the factors
  // of an extension.
  void readDielectric() {
    const JsonValue ior = extensions_["KHR_materials_ior"]["ior"];
    m_.ior = readNumber(ior, 1.5, 1, kLargestIor);
    // An index of 0 means a reflectance of 1, which the extension's color then replaces.
    const float step = ior.numberOr(1) == 0 ? 1 : (m_.ior - 1) / (m_.ior + 1);
    const JsonValue specular = extensions_["KHR_materials_specular"];
    m_.f90 = readNumber(specular["specularFactor"], 1);
    m_.specularColor =
        Rgb(step * step) * colorOf(specular["specularColorFactor"].numbers(3), kLargestEmission);
    // A lobe reflects a multiple of F0 at grazing incidence, which the color does not change. So
    // black is the darkest color that a texel holds.
    constexpr float kDarkest = 1.0f / (1023 * 1023);
    if (step > 0 && maxComponent(m_.specularColor) < kDarkest) m_.specularColor = Rgb(kDarkest);
    m_.specularMap = texture(specular["specularTexture"]);
    m_.specularColorMap = texture(specular["specularColorTexture"]);
  }

  void readVolume() {
    const JsonValue transmission = extensions_["KHR_materials_transmission"];
    m_.transmission = readNumber(transmission["transmissionFactor"], 0);
    m_.transmissionMap = texture(transmission["transmissionTexture"]);

    const JsonValue volume = extensions_["KHR_materials_volume"];
    warnIf(volume["thicknessTexture"].exists(),
           "thickness of a volume by a texture left out: what the mesh encloses counts");
    m_.thickness = readNumber(volume["thicknessFactor"], 0, 0, kLargestNumber);
    warnOfSpecularSolid();

    // Without a distance nothing is absorbed.
    const double distance = volume["attenuationDistance"].numberOr(0);
    const Rgb kept = colorOf(volume["attenuationColor"].numbers(3));
    if (!(distance > 0)) return;

    for (int i = 0; i < 3; ++i) {
      const double logarithm = std::log(double{std::max(kept[i], kLeastAttenuation)});
      m_.absorption[i] = static_cast<float>(std::min(-logarithm / distance, 1e18));
    }
  }

  // The interface of a solid reflects and transmits by its index of refraction alone. The factors
  // of KHR_materials_specular scale the highlights of lights.
  void warnOfSpecularSolid() const {
    const JsonValue specular = extensions_["KHR_materials_specular"];
    const Rgb color = colorOf(specular["specularColorFactor"].numbers(3), kLargestEmission);
    const bool isScaled = m_.f90 < 1 || !(color == Rgb(1.0f)) || m_.specularMap.exists() ||
                          m_.specularColorMap.exists();
    warnIf(isScaled && m_.transmission > 0 && m_.thickness > 0,
           "KHR_materials_specular of a material with a volume left out, but for the highlights of "
           "lights: it reflects by its ior alone");
  }

  void readClearcoat() {
    const JsonValue coat = extensions_["KHR_materials_clearcoat"];
    m_.clearcoat = readNumber(coat["clearcoatFactor"], 0);
    m_.clearcoatRoughness = readNumber(coat["clearcoatRoughnessFactor"], 0);
    m_.clearcoatMap = texture(coat["clearcoatTexture"]);
    m_.clearcoatRoughnessMap = texture(coat["clearcoatRoughnessTexture"]);
    warnIf(coat["clearcoatNormalTexture"].exists(), "normal map of a clearcoat left out");
    // A coat is a mirror, and mirrors of other materials, such as metals, dim no emission.
    warnIf(m_.clearcoat > 0 && maxComponent(m_.emission) > 0,
           "emission below a clearcoat not dimmed by it: too bright by what the coat reflects");
  }

  const GltfDocument& document_;
  const JsonValue& source_;
  const JsonValue extensions_;
  GltfMaterial m_;
};

// The reflectance at grazing incidence over that at normal incidence. Strengths and textures
// multiply both, so that the ratio is the material's. A metal has kGrazingRatio at least, since the
// texture of its color does not multiply what it reflects at grazing incidence.
float grazingRatioOf(const GltfMaterial& g, float metal) {
  if (g.grazingFades) return kGrazingRatio;
  constexpr float kLeast = 1e-18f;  // the ratio stays finite
  const float ratio = 1 / std::clamp(maxComponent(g.specularColor), kLeast, 1.0f);

  // A ratio that differs from that of the usual index of refraction by rounding alone is the usual
  // one.
  const bool isUsual = std::fabs(ratio - kGrazingRatio) < 1e-3f;
  return isUsual || (metal > 0 && ratio < kGrazingRatio) ? kGrazingRatio : ratio;
}

Rgb mix(const Rgb& a, const Rgb& b, float t) { return a * (1 - t) + b * t; }

// Sets where the surface is cut out, and how much of the rest is there.
void setCoverage(const GltfMaterial& g, const GltfMeans& means, Material& m) {
  m.alphaByVertex = g.multipliesAlpha();
  const bool cuts = g.alphaMode == GltfMaterial::Alpha::mask;
  m.alphaCutoff = cuts && g.alpha > 0 ? std::min(g.alphaCutoff / g.alpha, 1.0f) : 0.5f;
  m.thin = g.transmission > 0 && g.thickness == 0;

  // A blended surface is a thin sheet that covers a share of what is behind it.
  if (g.alphaMode == GltfMaterial::Alpha::blend) {
    m.coverage = std::min(g.alpha * means.alpha, 1.0f);
    m.thin = m.thin || means.alphaByMap;
    if (means.alphaByMap) m.alphaCutoff = kClearCoverage;
  }

  if (means.maskBlends) {
    m.thin = true;
    m.alphaCutoff = kClearCoverage;
  }

  // A mask that cuts everything, with or without a map.
  if (cuts && g.alpha < g.alphaCutoff) m.coverage = 0;
}

// The clearcoat is a mirror above all other layers, as far as it is smooth.
void addClearcoat(const GltfMaterial& g, const GltfMeans& means, Material& m) {
  const double roughness = g.clearcoatRoughness * means.clearcoatRoughness;
  const auto coat = static_cast<float>(g.clearcoat * means.clearcoat * mirroredShareOf(roughness));
  m.mirror = min(m.mirror + Rgb(0.04f * coat), Rgb(1.0f));
  m.mirrorGrazing = max(m.mirrorGrazing, Rgb(coat));
}

}  // namespace

const GltfTexture& GltfMaterial::surfaceMap() const {
  if (baseMap.exists()) return baseMap;
  if (mixesMetal()) return metallicRoughnessMap;
  if (variesF0()) return specularMap.exists() ? specularMap : specularColorMap;
  return variesTransmission() ? transmissionMap : baseMap;
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
  add(roughnessMap, !surfaceMap().exists() && variesRoughness());
  add(maskMap, !surfaceMap().exists() && maskMap.exists());
  add(normalMap, normalMap.exists());
  add(emissiveMap, emitsByMap());
  add(occlusionMap, occlusionMap.exists());
  return found;
}

std::optional<Repeats> repeatsOf(const GltfMaterial& m, const GltfTexture& texture) {
  const GltfMaterial::Coordinates known = m.coordinates();
  const GltfUvMap &own = texture.uv, &from = known.first;
  const bool maySecond =
      &texture == &m.normalMap || &texture == &m.emissiveMap || &texture == &m.occlusionMap;
  if (!texture.exists() || own == from || (maySecond && own == known.second)) return Repeats();

  Repeats r{own.uu / from.uu, own.vv / from.vv};
  r.u0 = own.u0 - r.u * from.u0;
  r.v0 = own.v0 - r.v * from.v0;
  r.isColor = &texture == &m.emissiveMap || &texture == &m.specularColorMap;

  constexpr double kMost = 1e4, kRounding = 1e-6;
  const auto isRegular = [](double times, double begin, Wrap wrap) {
    const bool isWhole = std::abs(times) < kMost && std::abs(times - std::round(times)) < kRounding;
    const bool repeats = wrap == Wrap::repeat || (times == 1 && begin == 0);
    return isWhole && repeats && std::isfinite(begin);
  };
  const bool isTurned = own.uv != 0 || own.vu != 0 || from.uv != 0 || from.vu != 0;
  const bool fits = own.set == from.set && !isTurned && isRegular(r.u, r.u0, texture.wrapU) &&
                    isRegular(r.v, r.v0, texture.wrapV);
  return fits ? std::optional(r) : std::nullopt;
}

bool lacksCoordinates(const GltfMaterial& m) {
  const auto lacks = [&](bool matters, const GltfTexture& map) {
    return matters && !repeatsOf(m, map);
  };
  return lacks(m.emitsByMap(), m.emissiveMap) || lacks(true, m.occlusionMap) ||
         lacks(m.variesTransmission(), m.transmissionMap) ||
         lacks(m.variesRoughness(), m.roughnessMap) ||
         lacks(m.mixesMetal(), m.metallicRoughnessMap) || lacks(true, m.maskMap) ||
         lacks(m.variesF0(), m.specularMap) || lacks(m.variesF0(), m.specularColorMap);
}

std::vector<GltfMaterial> readGltfMaterials(const GltfDocument& document) {
  std::vector<GltfMaterial> materials;
  for (const JsonValue& source : document.list("materials").elements()) {
    materials.push_back(GltfMaterialReader(document, source).read());
  }
  GltfMaterial fallback;
  fallback.name = kNoMaterialName;
  fallback.where = document.name();
  materials.push_back(fallback);
  return materials;
}

Material shadedAs(const GltfMaterial& g, const GltfMeans& means) {
  Material m;
  m.name = g.name;
  m.doubleSided = g.doubleSided;

  const float roughness = std::min(g.roughness * means.roughness, 1.0f);
  m.roughness = means.roughnessByMap ? g.roughness : roughness;
  m.emission = g.emission;

  const GltfMaterial::Coordinates coordinates = g.coordinates();
  m.normalBySecondUvs = coordinates.bySecond(g.normalMap);
  m.emissionBySecondUvs = coordinates.bySecond(g.emissiveMap);
  m.occlusionBySecondUvs = coordinates.bySecond(g.occlusionMap);

  setCoverage(g, means, m);

  // Unlit materials emit their color and do nothing else.
  if (g.unlit) {
    m.diffuse = Rgb(0.0f);
    m.emission = g.base;
    m.vertexTint = VertexTint::emission;
    m.castsShadow = m.blocksLight();
    return m;
  }

  // The diffuse color gets the light that metal does not reflect and glass does not transmit.
  const Rgb base = g.base * means.base;
  const Rgb f0 = g.f0(means.specularColor, means.specular);
  const float f90 = g.f90 * means.specular;
  const float metal = g.metallic * means.metallic;
  const float clear = g.variesTransmission() ? 0 : g.transmission;
  if (metal >= 0.5f) m.vertexTint = VertexTint::diffuseAndSpecular;
  m.diffuse = g.base * ((g.mixesMetal() ? 1 : 1 - metal) * (1 - clear));

  m.specular = g.bakesSpecular() ? Rgb(1.0f) : mix(f0, g.base, metal);
  m.grazingRatio = grazingRatioOf(g, metal);
  m.transmission = g.base * (g.transmission * (g.bakesTransmission() ? 1 : 1 - metal));

  if (m.boundsMedium()) {
    m.ior = g.ior;
    m.absorption = g.absorption;
  }

  m.frosted = m.hasTransmission();
  m.glossyReflection = !m.boundsMedium();
  m.coat = true;

  // Dielectrics mirror by their interface. The metal in them, as far as it is smooth, mirrors
  // besides.
  if (m.boundsMedium()) {
    const auto share = static_cast<float>(metal * mirroredShareOf(roughness));
    m.mirror = (g.mirrorsByMap() ? m.specular : mix(f0, base, metal)) * share;
    m.mirrorGrazing = Rgb((f90 * (1 - metal) + metal) * share);
  }

  addClearcoat(g, means, m);
  m.castsShadow = m.blocksLight();
  return m;
}

}  // namespace whit
