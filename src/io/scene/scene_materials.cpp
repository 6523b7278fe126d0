// The sections "textures" and "materials" of a scene file.
#include <cstdint>
#include <utility>

#include "core/index.h"
#include "core/text.h"
#include "io/scene/scene_sections.h"
#include "io/scene/scene_settings.h"
#include "scene/generation_limit.h"

namespace whit {
namespace {

const char* formatName(TexelFormat format) {
  return format == TexelFormat::data ? "data" : "color";
}

Wrap readWrapWord(const JsonValue& value) {
  const std::string word = value.word({"repeat", "mirror", "clamp"});
  if (word == "repeat") return Wrap::repeat;
  return word == "mirror" ? Wrap::mirror : Wrap::clamp;
}

// Reads how a texture (a Texture or its TextureSource) is looked up.
template <typename Sampled>
void readSampler(JsonObject& object, Sampled& sampled) {
  if (const JsonValue filter = object.find("filter")) {
    sampled.nearest = filter.word({"linear", "nearest"}) == "nearest";
  }

  const JsonValue wrap = object.find("wrap");
  if (!wrap) return;
  if (wrap.isArray()) {
    const auto both = wrap.elements(2, "one way to wrap, or two [u, v]");
    sampled.wrapU = readWrapWord(both[0]);
    sampled.wrapV = readWrapWord(both[1]);
  } else {
    sampled.wrapU = sampled.wrapV = readWrapWord(wrap);
  }
}

// Returns a value as text in which expressions are replaced by their numbers.
std::string recipeOf(const JsonValue& value) {
  if (value.isNumber()) return formatted("%a,", value.number());
  if (value.isText()) return value.text() + ",";

  std::string recipe;
  if (value.isArray()) {
    for (const JsonValue& element : value.elements()) recipe += recipeOf(element);
  } else if (value.isObject()) {
    for (const auto& [name, member] : value.members()) recipe += name + ":" + recipeOf(member);
  }
  return recipe;
}

// Reads the parameters of a pattern, whose texels are made later.
Texture makePattern(const JsonValue& definition, std::uint64_t mostBytes) {
  const GenerationLimit limit(mostBytes);
  JsonObject object(definition);
  const JsonValue pattern = object.need("pattern");
  Texture made = generate(pattern, patternGenerators(), object);
  made.name = pattern.text();

  readSampler(object, made);
  object.finish();
  made.shared->recipe = recipeOf(definition);
  return made;
}

[[noreturn]] void failFormat(const JsonValue& name, TexelFormat is, TexelFormat needed) {
  name.fail("a texture that is read as " + std::string(formatName(needed)) + " (this one is " +
            formatName(is) + ")");
}

}  // namespace

void warnOfSum(const Material& m, const std::string& where, Warnings& warnings) {
  constexpr float kMost = 1.1f;
  const bool lobe = m.glossyReflection && m.specularMap == kNoTexture;
  const std::pair<const char*, Rgb> parts[] = {
      {"mirror", m.mirror},
      {"specular", lobe ? m.specular : Rgb()},
      {"transmission", m.transmission},
      {"diffuse", m.diffuseMap == kNoTexture ? m.diffuse : Rgb()}};

  // Only the color channel with the largest sum is reported.
  Rgb sum;
  for (const auto& [name, part] : parts) sum += part;
  const int largest = largestAxis(sum);
  if (sum[largest] <= kMost) return;

  std::string text;
  for (const auto& [name, part] : parts) {
    if (part[largest] == 0) continue;
    text += formatted("%s%s %.4g", text.empty() ? "" : " + ", name, double{part[largest]});
  }
  warnings.add(kSumWarning,
               formatted("%s: %s = %.4g", where.c_str(), text.c_str(), double{sum[largest]}));
}

MaterialReader::MaterialReader(JsonObject& file, SceneContext& context) : context_(context) {
  for (const auto& [name, value] : file.find("textures").members()) {
    if (!value.isObject()) value.fail("an object");
    textures_.emplace(name, NamedTexture{value, {}});
  }

  for (const auto& [name, value] : file.find("materials").members()) {
    JsonObject object(value);
    Material material;
    material.name = name;
    material.pointer = value.pointer();
    read(object, material);
    object.finish();
    warnOfSum(material, value.where(), context_.warnings);
    materials_.emplace(name, add(material));
  }
}

std::uint32_t MaterialReader::find(const JsonValue& name) const {
  return findNamed(materials_, name, "a material")->second;
}

std::uint32_t MaterialReader::add(Material material) {
  context_.scene.materials.push_back(std::move(material));
  return size32(context_.scene.materials) - 1;
}

std::uint32_t MaterialReader::defaultMaterial() {
  const auto named = materials_.find("default");
  if (named != materials_.end()) return named->second;

  if (!default_) {
    Material material;
    material.name = "default";
    material.pointer = "/materials/default";
    default_ = add(material);
  }
  return *default_;
}

std::int32_t MaterialReader::load(const JsonValue& definition, const JsonValue& name,
                                  std::optional<TextureUse> use) {
  JsonObject object(definition);
  if (object.has("pattern")) {
    return context_.textures.add(1, [definition, name, use, &budget = context_.budget] {
      std::vector<std::optional<Texture>> made{makePattern(definition, budget.left())};
      if (!use) return made;
      if (made[0]->format != formatOf(*use)) failFormat(name, made[0]->format, formatOf(*use));
      made[0]->name = name.text();
      return made;
    })[0];
  }

  const bool isArray = context_.parts && object.has("array");
  const JsonValue image = object.need(isArray ? "array" : "image");

  TextureSource source;
  source.where = image.where();
  if (isArray) {
    source.given = &findNamed(context_.parts->images, image, "an array")->second;
  } else {
    source.path = context_.rules.resolve(image.text(), context_.folder, source.where).string();
  }
  readSampler(object, source);

  // A format that the scene file states must be the one that the material reads.
  TextureUse readAs = use.value_or(TextureUse::color);
  if (const JsonValue as = object.find("as")) {
    const bool isData = as.word({"color", "data"}) == "data";
    const TexelFormat is = isData ? TexelFormat::data : TexelFormat::color;
    if (use && is != formatOf(*use)) failFormat(name, is, formatOf(*use));
    if (isData) readAs = TextureUse::data;
  }

  object.finish();
  return context_.textures.add(source, {readAs})[0];
}

std::int32_t MaterialReader::texture(const JsonValue& name, TextureUse use) {
  findNamed(textures_, name, "a texture");
  NamedTexture& named = textures_.at(name.text());

  // Patterns do not exceed 1, so their emission needs no other format than color.
  const bool isPattern = JsonObject(named.definition).has("pattern");
  if (use == TextureUse::emission && isPattern) use = TextureUse::color;

  const auto known = named.slots.find(use);
  if (known != named.slots.end()) return known->second;
  return named.slots[use] = load(named.definition, name, use);
}

void MaterialReader::checkUnused() {
  for (const auto& [name, texture] : textures_) {
    if (texture.slots.empty()) load(texture.definition, texture.definition, std::nullopt);
  }
}

void MaterialReader::read(JsonObject& object, Material& material) {
  const auto readMap = [&](const JsonValue& name, const auto& map) {
    return texture(name, map.rules.use);
  };
  readMaterial(object, readMap, material);
}

void MaterialReader::override(JsonObject& object, Material& material, GivenMembers& given) {
  read(object, material);
  for (const auto& [name, value] : object.value().members()) given.insert(name);

  // Members that are given decide the defaults of others.
  forEachMember<Material>([&](const auto& member) {
    if (!given.contains(member.name)) return;
    for (const std::string_view name : member.rules.decides) given.emplace(name);
  });
}

void readMaterial(JsonObject& object, const ReadMap& readMap, Material& m) {
  readMembers(object, m);

  forEachMap([&](const auto& map) {
    const JsonValue name = object.find(map.name);
    if (name) m.*map.field = name.isNull() ? kNoTexture : readMap(name, map);
  });

  // Other members decide these defaults; see `decides` in scene/members.h.
  if (m.coverageMap != kNoTexture && m.alphaMap == kNoTexture) m.passClearTexels();
  const bool mirrors = object.has("mirror"), transmits = object.has("transmission");
  if (mirrors && !object.has("mirrorGrazing")) m.mirrorGrazing = m.mirror;
  if (mirrors && !object.has("coat")) m.coat = false;
  const bool hasImpulses = mirrors || transmits || object.has("mirrorGrazing");
  if (hasImpulses && !object.has("glossyReflection")) {
    m.glossyReflection = !m.hasMirror() && !m.hasTransmission();
  }
  if ((transmits || object.has("coverage")) && !object.has("castsShadow")) {
    m.castsShadow = m.blocksLight();
  }
}

}  // namespace whit
