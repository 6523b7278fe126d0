#include "io/obj/mtl_reader.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "io/obj/mtl_text.h"
#include "io/read_file.h"

namespace whit {
namespace {

constexpr std::uint64_t kMtlBytesLimit = 64u << 20;
constexpr float kDielectricReflectance = 0.04f;  // of what Pm below 1 leaves uncolored

class MtlMaterialReader {
 public:
  MtlMaterialReader(const tinyobj::material_t& source, const MtlSummary& summary,
                    Warnings& warnings)
      : source_(source), summary_(summary), warnings_(warnings) {}

  MtlMaterial convert() {
    result_.where = summary_.where;
    m_.name = source_.name;
    maps();
    colors();
    roughness();
    metalness();
    illumination();
    return std::move(result_);
  }

 private:
  bool has(const char* statement) const { return summary_.has.count(statement) > 0; }

  Rgb albedo(const tinyobj::real_t (&c)[3]) {
    const Rgb given(c[0], c[1], c[2]);
    const Rgb clamped = min(max(given, Rgb(0.0f)), Rgb(1.0f));
    if (!(given == clamped)) warnings_.add("material color clamped to [0, 1]", summary_.where);
    return clamped;
  }
  float unit(float x) {
    const float clamped = std::clamp(x, 0.0f, 1.0f);
    if (x != clamped) warnings_.add("material value clamped to [0, 1]", summary_.where);
    return clamped;
  }
  static MtlMaterial::Map map(const std::string& name, const tinyobj::texture_option_t& option) {
    return {name, option.clamp, option.bump_multiplier};
  }

  void maps() {
    result_.diffuse = map(source_.diffuse_texname, source_.diffuse_texopt);
    result_.specular = map(source_.specular_texname, source_.specular_texopt);
    result_.normal = map(source_.normal_texname, source_.normal_texopt);
    result_.bump = map(source_.bump_texname, source_.bump_texopt);
    result_.alpha = map(source_.alpha_texname, source_.alpha_texopt);
    for (const char* unsupported : {"map_Ke", "map_Pr", "map_Pm", "map_Ns"}) {
      if (has(unsupported)) warnings_.add("map that is not supported", summary_.where);
    }
  }

  void colors() {
    const bool diffuseMap = !result_.diffuse.name.empty();
    if (has("Kd")) {
      m_.diffuse = albedo(source_.diffuse);
    } else if (diffuseMap) {
      m_.diffuse = Rgb(1.0f);
    }
    if (has("Ks")) {
      m_.specular = albedo(source_.specular);
    } else if (!result_.specular.name.empty()) {
      m_.specular = Rgb(1.0f);
    }
    // With a map of it, Ke is a factor: without the map the whole surface would glow.
    if (has("Ke") && !has("map_Ke")) {
      m_.emission =
          max(Rgb(source_.emission[0], source_.emission[1], source_.emission[2]), Rgb(0.0f));
    }
  }

  void roughness() {
    if (has("Pr")) {
      m_.roughness = unit(source_.roughness);
    } else if (has("Ns")) {
      m_.roughness = std::pow(2.0f / (std::max(source_.shininess, 0.0f) + 2.0f), 0.25f);
    }
  }

  void metalness() {
    if (!has("Pm")) return;
    const float metal = unit(source_.metallic);
    const Rgb base = m_.hasGlossy() ? m_.specular : Rgb(kDielectricReflectance);
    m_.specular = base * (1 - metal) + m_.diffuse * metal;
    m_.diffuse *= 1 - metal;
  }

  void illumination() {
    const int illum = has("illum") ? source_.illum : 2;
    const bool glass = illum == 4 || illum == 6 || illum == 7 || illum == 9;
    const float dissolve = has("d") || has("Tr") ? unit(source_.dissolve) : 1;
    if (illum == 0 || illum == 1) m_.specular = Rgb(0.0f);
    if (illum == 3 || illum == 5 || illum == 8) {
      m_.mirror = m_.specular;
      m_.mirrorGrazing = illum == 5 ? Rgb(1.0f) : m_.mirror;
    }
    if (glass) {
      m_.transmission = has("Tf") ? albedo(source_.transmittance) : Rgb(1 - dissolve);
      m_.ior = index();
      m_.diffuse *= dissolve;
    } else {
      m_.coverage = dissolve;
    }
    m_.glossyReflection = !m_.hasMirror() && !m_.hasTransmission();
    m_.castsShadow = m_.blocksLight();
  }

  float index() {
    if (!has("Ni")) return m_.ior;
    if (source_.ior >= 1 && source_.ior <= kLargestIor) return source_.ior;
    warnings_.add("index of refraction clamped to [1, 10]", summary_.where);
    return std::clamp(source_.ior, 1.0f, kLargestIor);
  }

  const tinyobj::material_t& source_;
  const MtlSummary& summary_;
  Warnings& warnings_;
  MtlMaterial result_;
  Material& m_ = result_.material;
};

}  // namespace

void readMtl(const std::filesystem::path& path, std::map<std::string, MtlMaterial>& materials,
             Warnings& warnings) {
  const MtlText text = normalizeMtl(readTextFile(path, kMtlBytesLimit), path.string(), warnings);
  std::istringstream stream(text.text);
  std::map<std::string, int> indices;
  std::vector<tinyobj::material_t> found;
  std::string warning, error;
  tinyobj::LoadMtl(&indices, &found, &stream, &warning, &error);
  // In the same order: only a file without materials gives one more, without a name.
  for (std::size_t i = 0; i < text.materials.size() && i < found.size(); ++i) {
    const MtlSummary& summary = text.materials[i];
    if (materials.count(summary.name) > 0) continue;
    materials.emplace(summary.name, MtlMaterialReader(found[i], summary, warnings).convert());
  }
}

Material loadTextures(const MtlMaterial& source, const std::filesystem::path& folder,
                      const PathRules& rules, TextureLoader& textures) {
  Material material = source.material;
  const auto load = [&](const MtlMaterial::Map& map, const std::vector<TextureUse>& uses) {
    TextureSource image;
    image.where = source.where;
    image.path = rules.resolve(map.name, folder, source.where, /*backslashes=*/true).string();
    image.wrapU = image.wrapV = map.clamp ? Wrap::clamp : Wrap::repeat;
    image.bumpScale = map.bumpScale;
    image.lenient = true;
    return textures.add(image, uses);
  };
  const bool hasMask = !source.alpha.name.empty();
  if (!source.diffuse.name.empty()) {
    if (hasMask || !source.alphaFromDiffuse) {
      material.diffuseMap = load(source.diffuse, {TextureUse::color})[0];
    } else {
      const auto slots = load(source.diffuse, {TextureUse::color, TextureUse::colorAlpha});
      material.diffuseMap = slots[0];
      material.alphaMap = slots[1];
    }
  }
  if (hasMask) material.alphaMap = load(source.alpha, {TextureUse::mask})[0];
  if (material.hasGlossy() && !source.specular.name.empty()) {
    material.specularMap = load(source.specular, {TextureUse::color})[0];
  }
  if (!source.normal.name.empty()) {
    material.normalMap = load(source.normal, {TextureUse::data})[0];
  } else if (!source.bump.name.empty()) {
    material.normalMap = load(source.bump, {TextureUse::bump})[0];
  }
  return material;
}

}  // namespace whit
