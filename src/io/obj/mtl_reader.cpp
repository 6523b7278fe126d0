#include "io/obj/mtl_reader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/line_reader.h"
#include "io/read_file.h"

namespace whit {
namespace {

constexpr std::uint64_t kMtlBytesLimit = 64u << 20;
constexpr float kDielectricReflectance = 0.04f;  // of a Pm below 1, for the part that is not metal

// The statements of one material; the keywords are in lower case.
struct MtlStatements {
  std::string name;
  std::string where;                   // file:line of newmtl
  std::map<std::string, Rgb> numbers;  // single numbers as gray
  std::map<std::string, MtlMaterial::Map> maps;
};

class MtlParser {
 public:
  MtlParser(const std::string& text, const std::string& file, Warnings& warnings)
      : lines_(text, file), warnings_(warnings) {}

  std::vector<MtlStatements> parse() {
    for (; !lines_.done(); lines_.nextLine()) {
      keyword_ = lines_.word();
      std::string key = keyword_;
      for (char& c : key) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      if (key == "newmtl") {
        newMaterial();
      } else if (!materials_.empty()) {
        statement(key == "kt" ? "tf" : key);
      }
    }
    return std::move(materials_);
  }

 private:
  [[noreturn]] void fail(const std::string& expected) const {
    throwBadScene(lines_.place(), "expected " + expected + " after \"" + keyword_ + "\"");
  }

  void newMaterial() {
    const std::string name(lines_.rest());
    if (name.empty()) fail("a name");
    if (materials_.size() >= kMaterialLimit) {
      throwLimit(lines_.place() + ": more than " + std::to_string(kMaterialLimit) + " materials");
    }
    materials_.push_back({name, lines_.place(), {}, {}});
  }

  void statement(const std::string& key) {
    static const std::set<std::string> colors{"kd", "ks", "ke", "tf"};
    static const std::set<std::string> scalars{"ns", "ni", "d", "tr", "pr", "pm", "illum"};
    static const std::set<std::string> maps{"map_kd", "map_ks", "map_ke", "map_d",  "map_bump",
                                            "bump",   "norm",   "map_pr", "map_pm", "map_ns"};
    MtlStatements& material = materials_.back();
    if (colors.count(key) > 0) {
      if (const auto color = readColor()) material.numbers[key] = *color;
    } else if (scalars.count(key) > 0) {
      material.numbers[key] = Rgb(readScalar());
    } else if (maps.count(key) > 0) {
      material.maps[key == "map_bump" ? "bump" : key] = readMap();
    }
  }

  std::optional<float> readNumber() {
    double value = 0;
    if (!lines_.number(value) || !std::isfinite(static_cast<float>(value))) return std::nullopt;
    return static_cast<float>(value);
  }

  // g and b may be left out; they are then equal to r.
  std::optional<Rgb> readColor() {
    Rgb color;
    for (int i = 0; i < 3; ++i) {
      const auto value = i == 0 || lines_.hasMore() ? readNumber() : color[0];
      if (!value) {
        const std::string_view form = lines_.word();
        if (i > 0 || (form != "spectral" && form != "xyz")) fail("numbers");
        warnings_.add("material color in a form that is not supported", lines_.place());
        return std::nullopt;
      }
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

  // Options, then the name of the file: the rest of the line, which may contain blanks.
  MtlMaterial::Map readMap() {
    MtlMaterial::Map map;
    std::string_view word = lines_.word();
    for (; word.size() > 1 && word[0] == '-'; word = lines_.word()) readOption(word, map);
    if (word.empty()) fail("the name of a file");
    const std::string_view rest = lines_.rest();
    map.name = rest.empty() ? word : std::string(word.data(), rest.data() + rest.size());
    return map;
  }

  void readOption(std::string_view option, MtlMaterial::Map& map) {
    if (option == "-s" || option == "-o" || option == "-t" || option == "-mm") {
      warnings_.add("texture option that is not supported", lines_.place());
      double ignored = 0;
      for (int most = option == "-mm" ? 2 : 3; most > 0 && lines_.number(ignored); --most) continue;
      return;
    }
    const std::string_view argument = lines_.word();
    double scale = 1;
    if (option == "-bm" && parseNumber(argument.data(), argument.data() + argument.size(), scale) &&
        std::isfinite(static_cast<float>(scale))) {
      map.bumpScale = static_cast<float>(scale);
    }
    if (option == "-clamp") map.clamp = argument != "off";
  }

  LineReader lines_;
  std::string keyword_;  // of this line
  Warnings& warnings_;
  std::vector<MtlStatements> materials_;
};

// Makes a material from its statements.
class MtlConverter {
 public:
  MtlConverter(const MtlStatements& source, Warnings& warnings)
      : source_(source), warnings_(warnings) {}

  MtlMaterial convert() {
    result_.where = source_.where;
    m_.name = source_.name;
    maps();
    colors();
    roughness();
    metalness();
    illumination();
    return std::move(result_);
  }

 private:
  bool has(const char* keyword) const { return source_.numbers.count(keyword) > 0; }
  Rgb color(const char* keyword) const { return source_.numbers.at(keyword); }
  float number(const char* keyword) const { return color(keyword).x; }
  MtlMaterial::Map map(const char* keyword) const {
    const auto found = source_.maps.find(keyword);
    return found == source_.maps.end() ? MtlMaterial::Map() : found->second;
  }

  Rgb albedo(const Rgb& given) {
    const Rgb clamped = min(max(given, Rgb(0.0f)), Rgb(1.0f));
    if (!(given == clamped)) warnings_.add("material color clamped to [0, 1]", source_.where);
    return clamped;
  }
  float unit(float x) {
    const float clamped = std::clamp(x, 0.0f, 1.0f);
    if (x != clamped) warnings_.add("material value clamped to [0, 1]", source_.where);
    return clamped;
  }

  void maps() {
    result_.diffuse = map("map_kd");
    result_.specular = map("map_ks");
    result_.normal = map("norm");
    result_.bump = map("bump");
    result_.alpha = map("map_d");
    for (const char* unsupported : {"map_ke", "map_pr", "map_pm", "map_ns"}) {
      if (source_.maps.count(unsupported) > 0) {
        warnings_.add("map that is not supported", source_.where);
      }
    }
  }

  void colors() {
    if (has("kd")) {
      m_.diffuse = albedo(color("kd"));
    } else if (!result_.diffuse.name.empty()) {
      m_.diffuse = Rgb(1.0f);
    }
    if (has("ks")) {
      m_.specular = albedo(color("ks"));
    } else if (!result_.specular.name.empty()) {
      m_.specular = Rgb(1.0f);
    }
    // With a map of it, Ke is a factor: without the map the whole surface would glow.
    if (has("ke") && source_.maps.count("map_ke") == 0) {
      m_.emission = max(color("ke"), Rgb(0.0f));
    }
  }

  void roughness() {
    if (has("pr")) {
      m_.roughness = unit(number("pr"));
    } else if (has("ns")) {
      m_.roughness = std::pow(2.0f / (std::max(number("ns"), 0.0f) + 2.0f), 0.25f);
    }
  }

  void metalness() {
    if (!has("pm")) return;
    const float metal = unit(number("pm"));
    const Rgb base = m_.hasGlossy() ? m_.specular : Rgb(kDielectricReflectance);
    m_.specular = base * (1 - metal) + m_.diffuse * metal;
    m_.diffuse *= 1 - metal;
  }

  void illumination() {
    const float illum = has("illum") ? number("illum") : 2;
    const bool glass = illum == 4 || illum == 6 || illum == 7 || illum == 9;
    const float dissolve = has("d") ? unit(number("d")) : has("tr") ? unit(1 - number("tr")) : 1;
    if (illum == 0 || illum == 1) m_.specular = Rgb(0.0f);
    if (illum == 3 || illum == 5 || illum == 8) {
      m_.mirror = m_.specular;
      m_.mirrorGrazing = illum == 5 ? Rgb(1.0f) : m_.mirror;
    }
    if (glass) {
      m_.transmission = has("tf") ? albedo(color("tf")) : Rgb(1 - dissolve);
      m_.ior = index();
      m_.diffuse *= dissolve;
    } else {
      m_.coverage = dissolve;
    }
    m_.glossyReflection = !m_.hasMirror() && !m_.hasTransmission();
    m_.castsShadow = m_.blocksLight();
  }

  float index() {
    if (!has("ni")) return m_.ior;
    const float clamped = std::clamp(number("ni"), 1.0f, kLargestIor);
    if (clamped != number("ni")) {
      warnings_.add("index of refraction clamped to [1, 10]", source_.where);
    }
    return clamped;
  }

  const MtlStatements& source_;
  Warnings& warnings_;
  MtlMaterial result_;
  Material& m_ = result_.material;
};

}  // namespace

void readMtl(const std::filesystem::path& path, std::map<std::string, MtlMaterial>& materials,
             Warnings& warnings) {
  const std::string text = readTextFile(path, kMtlBytesLimit), file = path.string();
  for (const MtlStatements& source : MtlParser(text, file, warnings).parse()) {
    if (materials.count(source.name) > 0) continue;
    materials.emplace(source.name, MtlConverter(source, warnings).convert());
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
