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
#include "io/files.h"
#include "io/line_reader.h"

namespace whit {
namespace {

constexpr std::uint64_t kMtlBytesLimit = 64u << 20;
constexpr float kDielectricReflectance = 0.04f;  // of a Pm below 1, for the part that is not metal

class MtlParser {
 public:
  MtlParser(const std::string& text, const std::string& file, Warnings& warnings)
      : lines_(text, file), warnings_(warnings) {}

  std::vector<MtlMaterial> parse() {
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
    MtlMaterial& material = materials_.emplace_back();
    material.material.name = name;
    material.where = lines_.place();
  }

  void statement(const std::string& key) {
    static const std::set<std::string> colors{"kd", "ks", "ke", "tf"};
    static const std::set<std::string> scalars{"ns", "ni", "d", "tr", "pr", "pm", "illum"};
    static const std::set<std::string> maps{"map_kd", "map_ks", "map_ke", "map_d",  "map_bump",
                                            "bump",   "norm",   "map_pr", "map_pm", "map_ns"};
    MtlMaterial& material = materials_.back();
    if (colors.contains(key)) {
      material.numbers[key] = readColor();
    } else if (scalars.contains(key)) {
      material.numbers[key] = Rgb(readScalar());
    } else if (maps.contains(key)) {
      material.maps[key == "map_bump" ? "bump" : key] = readMap();
    }
  }

  std::optional<float> readNumber() {
    double value = 0;
    if (!lines_.number(value) || !std::isfinite(static_cast<float>(value))) return std::nullopt;
    return static_cast<float>(value);
  }

  // g and b may be left out; they are then equal to r.
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
  std::vector<MtlMaterial> materials_;
};

// Sets what the statements of a material mean. MeshLab writes Tr where others write d.
void interpret(MtlMaterial& source, bool isFromMeshLab, Warnings& warnings) {
  Material& m = source.material;
  const auto has = [&](const char* keyword) { return source.numbers.contains(keyword); };
  const auto number = [&](const char* keyword) { return source.numbers.at(keyword).x; };
  const auto color = [&](const char* keyword) {
    const Rgb given = source.numbers.at(keyword), clamped = min(max(given, Rgb(0.0f)), Rgb(1.0f));
    if (!(given == clamped)) warnings.add("material color clamped to [0, 1]", source.where);
    return clamped;
  };
  const auto unit = [&](float x) {
    const float clamped = std::clamp(x, 0.0f, 1.0f);
    if (x != clamped) warnings.add("material value clamped to [0, 1]", source.where);
    return clamped;
  };
  for (const char* unsupported : {"map_ke", "map_pr", "map_pm", "map_ns"}) {
    if (source.maps.contains(unsupported)) warnings.add("map that is not supported", source.where);
  }
  if (source.maps.contains("map_kd")) m.diffuse = Rgb(1.0f);
  if (source.maps.contains("map_ks")) m.specular = Rgb(1.0f);
  if (has("kd")) m.diffuse = color("kd");
  if (has("ks")) m.specular = color("ks");
  // With a map of it, Ke is a factor: without the map the whole surface would glow.
  if (has("ke") && !source.maps.contains("map_ke")) {
    m.emission = max(source.numbers.at("ke"), Rgb(0.0f));
  }
  if (has("pr")) {
    m.roughness = unit(number("pr"));
  } else if (has("ns")) {
    m.roughness = std::pow(2.0f / (std::max(number("ns"), 0.0f) + 2.0f), 0.25f);
  }
  if (has("pm")) {
    const float metal = unit(number("pm"));
    const Rgb base = m.hasGlossy() ? m.specular : Rgb(kDielectricReflectance);
    m.specular = base * (1 - metal) + m.diffuse * metal;
    m.diffuse *= 1 - metal;
  }
  const float illum = has("illum") ? number("illum") : 2;
  const bool isGlass = illum == 4 || illum == 6 || illum == 7 || illum == 9;
  // Nobody means a material that is not there.
  const bool isGone = has("tr") && !has("d") && !isFromMeshLab && number("tr") == 1 && !isGlass;
  if (isGone) warnings.add("material that Tr 1 makes invisible taken as opaque", source.where);
  const float transparency = has("tr") && !isGone ? unit(number("tr")) : 0;
  const float dissolve = has("d")        ? unit(number("d"))
                         : isFromMeshLab ? (has("tr") ? transparency : 1)
                                         : 1 - transparency;
  if (illum == 0 || illum == 1) m.specular = Rgb(0.0f);
  if (illum == 3 || illum == 5 || illum == 8) {
    m.mirror = m.specular;
    m.mirrorGrazing = illum == 5 ? Rgb(1.0f) : m.mirror;
  }
  if (isGlass) {
    m.transmission = has("tf") ? color("tf") : Rgb(1 - dissolve);
    if (has("ni")) m.ior = std::clamp(number("ni"), 1.0f, kLargestIor);
    if (has("ni") && m.ior != number("ni")) {
      warnings.add("index of refraction clamped to [1, 10]", source.where);
    }
    m.diffuse *= dissolve;
  } else {
    m.coverage = dissolve;
  }
  m.glossyReflection = !m.hasMirror() && !m.hasTransmission();
  m.castsShadow = m.blocksLight();
}

}  // namespace

void readMtl(const std::filesystem::path& path, std::map<std::string, MtlMaterial>& materials,
             Warnings& warnings) {
  const std::string text = readTextFile(path, kMtlBytesLimit), file = path.string();
  const bool isFromMeshLab = text.find("# Converted by Meshlab") < text.find("newmtl");
  for (MtlMaterial& source : MtlParser(text, file, warnings).parse()) {
    if (materials.contains(source.material.name)) continue;
    interpret(source, isFromMeshLab, warnings);
    materials.emplace(source.material.name, source);
  }
}

Material loadTextures(const MtlMaterial& source, Material material, const GivenMembers& given,
                      const std::filesystem::path& folder, const PathRules& rules,
                      TextureLoader& textures, Warnings& warnings) {
  const auto has = [&](const char* keyword, const char* member) {
    return source.maps.contains(keyword) && !given.contains(member);
  };
  const auto load = [&](const char* keyword, const std::vector<TextureUse>& uses) {
    const MtlMaterial::Map& map = source.maps.at(keyword);
    TextureSource image;
    image.where = source.where;
    try {
      image.path = rules.resolve(map.name, folder, source.where, /*backslashes=*/true).string();
    } catch (const Error& error) {
      warnings.add("texture left out", error.what());
      return std::vector(uses.size(), kNoTexture);
    }
    image.wrapU = image.wrapV = map.clamp ? Wrap::clamp : Wrap::repeat;
    image.bumpScale = map.bumpScale;
    image.lenient = true;
    return textures.add(image, uses);
  };
  if (has("map_kd", "diffuseMap")) {
    std::vector<TextureUse> uses{TextureUse::color};
    const bool usesAlpha = !source.maps.contains("map_d") && !given.contains("alphaMap");
    if (usesAlpha) uses.push_back(TextureUse::colorAlpha);
    const auto slots = load("map_kd", uses);
    material.diffuseMap = slots[0];
    if (usesAlpha) material.alphaMap = slots[1];
  }
  if (has("map_d", "alphaMap")) material.alphaMap = load("map_d", {TextureUse::mask})[0];
  if (material.hasGlossy() && has("map_ks", "specularMap")) {
    material.specularMap = load("map_ks", {TextureUse::color})[0];
  }
  if (has("norm", "normalMap")) {
    material.normalMap = load("norm", {TextureUse::data})[0];
  } else if (has("bump", "normalMap")) {
    material.normalMap = load("bump", {TextureUse::bump})[0];
  }
  return material;
}

}  // namespace whit
