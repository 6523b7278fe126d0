#include "io/obj/mtl_reader.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/text.h"
#include "io/files.h"
#include "io/line_reader.h"

namespace whit {
namespace {

constexpr std::uint64_t kMtlBytesLimit = 64u << 20;
constexpr float kDielectricReflectance = 0.04f;  // where a metalness is given without Ks
constexpr float kReflectanceOfKs = 0.08f;        // Ks 0.5, Blender's default, means 0.04
constexpr float kLargestKe = 1e9f;

class MtlParser {
 public:
  MtlParser(const std::string& text, const std::string& file, Warnings& warnings)
      : lines_(text, file), warnings_(warnings) {}

  std::vector<MtlMaterial> parse() {
    for (; !lines_.done(); lines_.nextLine()) {
      keyword_ = lines_.word();
      if (keyword_.empty() || keyword_[0] == '#') continue;
      try {
        statement();
      } catch (const Error& error) {
        if (error.status() != ExitStatus::badScene) throw;
        warnings_.add("line of a material library that cannot be read left out", error.what());
      }
    }
    return std::move(materials_);
  }

 private:
  [[noreturn]] void fail(const std::string& expected) const {
    throwBadScene(lines_.place(), "expected " + expected + " after \"" + keyword_ + "\"");
  }

  void newMaterial() {
    if (materials_.size() >= kMaterialLimit) {
      throwLimit(concat(lines_.place(), ": more than ", kMaterialLimit, " materials"));
    }
    MtlMaterial& material = materials_.emplace_back();
    material.name = lines_.rest();
    material.where = lines_.place();
    if (material.name.empty()) fail("a name");
  }

  void statement() {
    static const std::set<std::string> colors{"kd", "ks", "ke", "tf"};
    static const std::set<std::string> scalars{"ns", "ni", "d",   "tr",   "pr",
                                               "pm", "pc", "pcr", "illum"};
    static const std::set<std::string> maps{"map_kd", "map_ks", "map_ke", "map_d",  "bump",
                                            "norm",   "map_pr", "map_pm", "map_pc", "map_pcr"};
    static const std::map<std::string, std::string> synonyms{
        {"kt", "tf"}, {"map_bump", "bump"}, {"map_norm", "norm"}, {"norm_map", "norm"}};

    std::string key = keyword_;
    for (char& c : key) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (const auto synonym = synonyms.find(key); synonym != synonyms.end()) key = synonym->second;

    if (key == "newmtl") newMaterial();
    if (key == "newmtl" || materials_.empty()) return;

    MtlMaterial& material = materials_.back();
    if (colors.contains(key)) {
      material.numbers[key] = readColor();
    } else if (scalars.contains(key)) {
      material.numbers[key] = Rgb(readScalar());
    } else if (maps.contains(key) || key == "map_ka") {
      material.maps[key] = readMap();
    } else if (key == "ka") {
      // It is the metalness in files of Blender; in other files it may be in any form.
      const auto ambient = readNumber();
      if (ambient) material.numbers[key] = Rgb(*ambient);
    } else {
      warnings_.add("statement of a material that is not read: " + excerpt(keyword_),
                    lines_.place());
    }
  }

  std::optional<float> readNumber() {
    double value = 0;
    if (!lines_.number(value) || !std::isfinite(static_cast<float>(value))) return std::nullopt;
    return static_cast<float>(value);
  }

  // Reads r, g and b. The last two may be left out; they are then equal to r.
  Rgb readColor() {
    Rgb color;
    for (int i = 0; i < 3; ++i) {
      const auto value = i == 0 || lines_.hasMore() ? readNumber() : color[0];
      if (!value) fail("numbers");
      color[i] = *value;
    }
    return color;
  }

  float readScalar() {
    auto value = readNumber();
    if (!value && lines_.word() == "-halo") value = readNumber();
    if (!value) fail("a number");
    return *value;
  }

  // Reads options, and then the name of the file: the rest of the line, which may contain blanks.
  MtlMaterial::Map readMap() {
    MtlMaterial::Map map;
    map.where = lines_.place();
    std::string_view word = lines_.word();
    for (; word.size() > 1 && word[0] == '-'; word = lines_.word()) readOption(word, map);
    if (word.empty()) fail("the name of a file");
    const std::string_view rest = lines_.rest();
    map.name = rest.empty() ? word : std::string(word.data(), rest.data() + rest.size());
    return map;
  }

  // Reads up to three numbers. Components for which the line has no number keep their values.
  void readNumbers(Vec3f& to, int most = 3) {
    double value = 0;
    for (int i = 0; i < most && lines_.number(value); ++i) to[i] = static_cast<float>(value);
  }

  void readOption(std::string_view option, MtlMaterial::Map& map) {
    if (option == "-s") {
      readNumbers(map.scale);
      return;
    }
    if (option == "-o") {
      readNumbers(map.offset);
      return;
    }

    if (option == "-t" || option == "-mm") {
      Vec3f ignored;
      readNumbers(ignored, option == "-t" ? 3 : 2);
    } else if (option == "-bm") {
      const auto scale = readNumber();
      if (!scale) fail("a number behind -bm");
      map.bumpScale = *scale;
      return;
    } else {
      const std::string_view argument = lines_.word();
      if (option == "-clamp") map.clamp = argument != "off";
      // Textures are interpolated, as the format has it by default.
      const bool isDefault = option.starts_with("-blend") && argument == "on";
      if (option == "-clamp" || isDefault) return;
    }
    warnings_.add("texture option that is not supported: " + std::string(option), map.where);
  }

  LineReader lines_;
  std::string keyword_;  // keyword of this line
  Warnings& warnings_;
  std::vector<MtlMaterial> materials_;
};

// Tells what the statements of one material mean.
class Interpreter {
 public:
  Interpreter(const MtlMaterial& source, const std::filesystem::path& folder,
              const PathRules& rules, std::vector<GltfImageSource>& images, Warnings& warnings)
      : source_(source), folder_(folder), rules_(rules), images_(images), warnings_(warnings) {}

  ObjMaterial interpret() {
    ObjMaterial result;
    GltfMaterial& m = result.surface;
    m.name = source_.name;
    m.where = source_.where;
    m.doubleSided = true;

    illum_ = numberOr("illum", 2);
    result.dissolve = dissolve();
    readMaps(m);
    m.base = Rgb(source_.hasMap("map_kd") ? 1.0f : 0.8f);
    if (source_.has("kd")) m.base = color("kd");
    readSurface(m);
    readReflectance(result);
    if (isGlass()) readGlass(result);
    return result;
  }

 private:
  float numberOr(const char* keyword, float fallback) const {
    return source_.has(keyword) ? source_.numbers.at(keyword).x : fallback;
  }

  Rgb color(const char* keyword) {
    const Rgb given = source_.numbers.at(keyword), clamped = min(max(given, Rgb(0.0f)), Rgb(1.0f));
    if (!(given == clamped)) warnings_.add("material color clamped to [0, 1]", source_.where);
    return clamped;
  }

  float unit(const char* keyword, float fallback) {
    const float given = numberOr(keyword, fallback), clamped = std::clamp(given, 0.0f, 1.0f);
    if (given != clamped) warnings_.add("material value clamped to [0, 1]", source_.where);
    return clamped;
  }

  bool isGlass() const {
    const bool isAlpha = source_.isFromBlender && (illum_ == 6 || illum_ == 9);
    return (illum_ == 4 || illum_ == 6 || illum_ == 7 || illum_ == 9) && !isAlpha;
  }

  // Returns the share of the surface that is there. MeshLab writes Tr where others write d.
  float dissolve() {
    if (source_.has("d")) return unit("d", 1);
    const float transparency = unit("tr", source_.isFromMeshLab ? 1 : 0);
    if (source_.isFromMeshLab) return transparency;

    // Nobody wants an invisible material.
    const bool isGone = numberOr("tr", 0) == 1 && !isGlass();
    if (isGone) {
      warnings_.add("material that Tr 1 makes invisible taken as opaque", source_.where);
    }
    return isGone ? 1 : 1 - transparency;
  }

  GltfTexture texture(const char* keyword) {
    GltfTexture texture;
    const auto found = source_.maps.find(keyword);
    if (found == source_.maps.end()) return texture;
    const MtlMaterial::Map& map = found->second;

    GltfImageSource image;
    image.where = map.where;
    try {
      image.path = rules_.find(map.name, folder_, map.where, warnings_).string();
    } catch (const Error& error) {
      warnings_.add("texture left out", error.what());
      return texture;
    }

    std::error_code error;
    if (!std::filesystem::exists(image.path, error)) {
      warnings_.add("texture left out",
                    map.where + ": cannot open " + image.path + ": no such file");
      return texture;
    }

    const auto known = std::ranges::find(images_, image.path, &GltfImageSource::path);
    texture.image = known - images_.begin();
    if (known == images_.end()) images_.push_back(std::move(image));
    texture.wrapU = texture.wrapV = map.clamp ? Wrap::clamp : Wrap::repeat;

    // u' = offset + scale u and v' = offset + scale v, with v pointing up.
    texture.uv.uu = double{map.scale.x};
    texture.uv.u0 = double{map.offset.x};
    texture.uv.vv = double{map.scale.y};
    texture.uv.v0 = 1.0 - double{map.offset.y} - double{map.scale.y};
    return texture;
  }

  void readMaps(GltfMaterial& m) {
    m.baseMap = texture("map_kd");
    m.maskMap = texture("map_d");
    m.metallicRoughnessMap = texture("map_pm");
    m.roughnessMap = texture("map_pr");
    m.emissiveMap = texture("map_ke");
    m.clearcoatMap = texture("map_pc");
    m.clearcoatRoughnessMap = texture("map_pcr");
    if (m.baseMap.exists() || m.maskMap.exists()) m.alphaMode = GltfMaterial::Alpha::mask;
    m.maskMayBlend = m.alphaMode == GltfMaterial::Alpha::mask;

    m.normalMap = texture("norm");
    const char* normals = "norm";
    if (!m.normalMap.exists()) {
      normals = "bump";
      m.normalMap = texture(normals);
      m.normalsMayBeHeights = true;
    }
    if (m.normalMap.exists()) m.normalScale = source_.maps.at(normals).bumpScale;

    if (source_.hasMap("map_ka") && !source_.hasMap("map_kd")) {
      warnings_.add("map of the ambient color left out", source_.maps.at("map_ka").where);
    }
  }

  // Sets roughness, metalness, clearcoat and emission.
  void readSurface(GltfMaterial& m) {
    const float exponent = std::max(numberOr("ns", 0), 0.0f);
    m.roughness = m.roughnessMap.exists() ? 1 : 0.5f;
    if (source_.has("pr")) {
      m.roughness = unit("pr", 0);
    } else if (source_.has("ns") && source_.isFromBlender) {
      m.roughness = 1 - std::sqrt(std::min(exponent / 1000, 1.0f));
    } else if (source_.has("ns")) {
      m.roughness = std::pow(2.0f / (exponent + 2.0f), 0.25f);
    }

    m.metallic = unit("pm", m.metallicRoughnessMap.exists() ? 1 : 0);
    const bool isMetalOfBlender = source_.isFromBlender && (illum_ == 3 || illum_ == 6);
    if (isMetalOfBlender && !source_.has("pm")) m.metallic = unit("ka", 1);
    m.clearcoat = unit("pc", m.clearcoatMap.exists() ? 1 : 0);
    m.clearcoatRoughness = unit("pcr", m.clearcoatRoughnessMap.exists() ? 1 : 0);

    // Some programs write Ke 0 beside the map.
    const Rgb emitted = source_.has("ke") ? source_.numbers.at("ke") : Rgb(0.0f);
    m.emission = min(max(emitted, Rgb(0.0f)), Rgb(kLargestKe));
    if (m.emissiveMap.exists() && !(maxComponent(m.emission) > 0)) m.emission = Rgb(1.0f);
  }

  void readReflectance(ObjMaterial& result) {
    GltfMaterial& m = result.surface;
    m.specularColorMap = texture("map_ks");
    const bool isMetallic = m.metallic > 0 || source_.has("pm");
    Rgb highlight(m.specularColorMap.exists() ? 1.0f : 0.0f);
    if (source_.has("ks")) highlight = color("ks");
    const bool isMirror = (illum_ == 3 || illum_ == 5 || illum_ == 8) && !isMetallic;

    m.specularColor = highlight * (isMirror ? 1.0f : kReflectanceOfKs);
    if (isMetallic && !(maxComponent(highlight) > 0)) m.specularColor = Rgb(kDielectricReflectance);
    if (illum_ == 0 || illum_ == 1) m.specularColor = Rgb(0.0f);
    m.f90 = maxComponent(m.specularColor) > 0 ? 1.0f : 0.0f;
    m.grazingFades = true;

    // A roughness that is given makes a rough metal of a mirror.
    const bool isRough = source_.has("pr") && m.roughness > kBlurredRoughness;
    if (!isMirror || isRough) return;
    result.mirror = highlight;
    result.mirrorGrazing = illum_ == 5 ? Rgb(1.0f) : highlight;
    result.surface.mirrorIsApart = true;
  }

  void readGlass(ObjMaterial& result) {
    GltfMaterial& m = result.surface;
    result.transmission = source_.has("tf") ? color("tf") : Rgb(1 - result.dissolve);
    const float index = numberOr("ni", m.ior);
    m.ior = std::clamp(index, 1.0f, kLargestIor);
    if (m.ior != index) warnings_.add("index of refraction clamped to [1, 10]", source_.where);
    m.base *= result.dissolve;
    result.dissolve = 1;
  }

  const MtlMaterial& source_;
  const std::filesystem::path& folder_;
  const PathRules& rules_;
  std::vector<GltfImageSource>& images_;
  Warnings& warnings_;
  float illum_ = 2;
};

}  // namespace

void readMtl(const std::filesystem::path& path, std::map<std::string, MtlMaterial>& materials,
             Warnings& warnings) {
  const std::string text = readTextFile(path, kMtlBytesLimit), file = path.string();
  const auto isFrom = [&](const char* program) { return text.find(program) < text.find("newmtl"); };
  const bool isFromMeshLab = isFrom("# Converted by Meshlab"), isFromBlender = isFrom("# Blender");
  for (MtlMaterial& source : MtlParser(text, file, warnings).parse()) {
    source.isFromMeshLab = isFromMeshLab;
    source.isFromBlender = isFromBlender;
    materials.emplace(source.name, source);
  }
}

ObjMaterial interpretMtl(const MtlMaterial& source, const std::filesystem::path& folder,
                         const PathRules& rules, std::vector<GltfImageSource>& images,
                         Warnings& warnings) {
  return Interpreter(source, folder, rules, images, warnings).interpret();
}

Material shadedAs(const ObjMaterial& source, const GltfMeans& means) {
  Material m = shadedAs(source.surface, means);
  m.coverage = source.dissolve;
  if (maxComponent(source.mirrorGrazing) > 0) {
    m.mirror = source.mirror * means.specularColor;
    m.mirrorGrazing = source.mirrorGrazing * means.specularColor;
    m.glossyReflection = false;
  }
  if (maxComponent(source.transmission) > 0) {
    m.transmission = source.transmission;
    m.ior = source.surface.ior;
    m.mirror = m.mirrorGrazing = Rgb(0.0f);
    m.glossyReflection = false;
  }
  m.castsShadow = m.blocksLight();
  return m;
}

}  // namespace whit
