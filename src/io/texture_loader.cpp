#include "io/texture_loader.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/error.h"
#include "io/image/texture_from_image.h"

namespace whit {
namespace {

std::uint64_t texelsOf(const RawImage& raw) {
  return static_cast<std::uint64_t>(raw.width) * static_cast<std::uint64_t>(raw.height);
}

// Returns nothing if the image has no such texture.
std::optional<Texture> makeUse(const std::string& name, const RawImage& raw, TextureUse use,
                               const TextureSource& source, Warnings& warnings) {
  switch (use) {
    case TextureUse::color:
      warnOfClampedColors(name, raw, warnings);
      return makeTexture(name, raw, TexelFormat::color);
    case TextureUse::emission:
      return makeEmissionTexture(name, raw, warnings);
    case TextureUse::data:
      return makeTexture(name, raw, TexelFormat::data);
    case TextureUse::bump:
      if (!looksLikeHeights(raw)) return makeTexture(name, raw, TexelFormat::data);
      return normalsFromHeights(name, raw, source.bumpScale, source.wrapU, source.wrapV);
    case TextureUse::mask:
      return hasTranslucentAlpha(raw) ? makeTexture(name, alphaOf(raw), TexelFormat::data)
                                      : makeTexture(name, raw, TexelFormat::data);
    case TextureUse::colorAlpha:
      if (!hasTranslucentAlpha(raw)) return std::nullopt;
      return makeTexture(name, alphaOf(raw), TexelFormat::data);
  }
  return std::nullopt;
}

}  // namespace

TextureLoader::TextureLoader(int threads, MemoryBudget& budget, Warnings& warnings,
                             Progress* progress)
    : budget_(budget), warnings_(warnings), queue_(threads, progress, "making textures") {}

std::vector<std::int32_t> TextureLoader::add(const TextureSource& source,
                                             const std::vector<TextureUse>& uses) {
  std::vector<std::int32_t> slots, newSlots;
  std::vector<TextureUse> newUses;
  for (TextureUse use : uses) {
    if (use == TextureUse::emission && !holdsRadiance(source.path)) use = TextureUse::color;
    const Key key{source.path, use, source.wrapU, source.wrapV,
                  use == TextureUse::bump ? source.bumpScale : 1.0f};
    const auto [entry, isNew] = known_.emplace(key, static_cast<std::int32_t>(slots_.size()));
    slots.push_back(entry->second);
    if (!isNew) continue;
    slots_.emplace_back();
    newSlots.push_back(entry->second);
    newUses.push_back(use);
  }
  if (!newUses.empty()) {
    std::vector<std::optional<Texture>*> targets;
    targets.reserve(newSlots.size());
    for (const std::int32_t slot : newSlots) {
      targets.push_back(&slots_[static_cast<std::size_t>(slot)]);
    }
    queue_.add([this, source, newUses, targets] { decode(source, newUses, targets); });
  }
  return slots;
}

std::int32_t TextureLoader::add(const GivenImage& image, const TextureSource& source,
                                TextureUse use) {
  const auto slot = static_cast<std::int32_t>(slots_.size());
  std::optional<Texture>* const target = &slots_.emplace_back();
  queue_.add([this, &image, source, use, target] {
    const std::uint64_t bytes = image.codes.size_bytes() + image.values.size_bytes();
    const MemoryHold copy(&budget_, 1, bytes, source.where);
    const RawImage raw = imageOf(image, source.where);
    *target = make(source.where, raw, use, source);
  });
  return slot;
}

std::int32_t TextureLoader::add(std::function<Texture()> make) {
  return add(1, [make = std::move(make)] {
    std::vector<std::optional<Texture>> made;
    made.emplace_back(make());
    return made;
  })[0];
}

std::vector<std::int32_t> TextureLoader::add(
    std::size_t count, std::function<std::vector<std::optional<Texture>>()> make) {
  std::vector<std::int32_t> slots;
  std::vector<std::optional<Texture>*> targets;
  for (std::size_t i = 0; i < count; ++i) {
    slots.push_back(static_cast<std::int32_t>(slots_.size()));
    targets.push_back(&slots_.emplace_back());
  }
  queue_.add([this, make = std::move(make), targets] {
    std::vector<std::optional<Texture>> made = make();
    for (std::size_t i = 0; i < targets.size(); ++i) {
      if (!made[i]) continue;
      budget_.charge(made[i]->texels.size(), sizeof(std::uint32_t), "texture " + made[i]->name);
      *targets[i] = std::move(made[i]);
    }
  });
  return slots;
}

void TextureLoader::whenDone(std::function<void(SceneDescription&)> change) {
  changes_.push_back(std::move(change));
}

void TextureLoader::addEnvironment(const std::string& path, EnvironmentImage& image) {
  queue_.add([this, path, &image] {
    const RawImage raw = read(path);
    MemoryHold planes(&budget_, texelsOf(raw), 3 * sizeof(float), path);
    image = makeEnvironment(raw);
    planes.keep();
  });
}

ImageLimits TextureLoader::limits() const {
  ImageLimits limits;
  limits.budget = &budget_;
  return limits;
}

MemoryHold TextureLoader::holdCopy(const RawImage& raw, TextureUse use) {
  const bool copies = use == TextureUse::mask || use == TextureUse::colorAlpha;
  return {&budget_, copies ? texelsOf(raw) : 0, raw.linear ? sizeof(float) : 1, "an alpha channel"};
}

RawImage TextureLoader::read(const std::string& path) {
  return readRawImage(path, limits(), warnings_);
}

void TextureLoader::decode(const TextureSource& source, const std::vector<TextureUse>& uses,
                           const std::vector<std::optional<Texture>*>& targets) {
  RawImage raw;
  try {
    raw = read(source.path);
  } catch (const Error& error) {
    if (!source.lenient || error.status() == ExitStatus::limit) throw;
    warnings_.add("texture left out", source.where + ": " + error.what());
    return;
  }
  const std::string name = std::filesystem::path(source.path).filename().string();
  for (std::size_t i = 0; i < uses.size(); ++i) *targets[i] = make(name, raw, uses[i], source);
}

std::optional<Texture> TextureLoader::make(const std::string& name, const RawImage& raw,
                                           TextureUse use, const TextureSource& source) {
  MemoryHold texels(&budget_, texelsOf(raw), sizeof(std::uint32_t), name);
  const MemoryHold copy = holdCopy(raw, use);
  std::optional<Texture> texture = makeUse(name, raw, use, source, warnings_);
  if (!texture) return texture;
  texels.keep();
  texture->wrapU = source.wrapU;
  texture->wrapV = source.wrapV;
  return texture;
}

void TextureLoader::finish(SceneDescription& scene) {
  queue_.finish();
  for (const auto& change : changes_) change(scene);
  // Unused slots are dropped: a color without alpha leaves an empty one, and an override may have
  // replaced a map.
  std::vector<std::int32_t> number(slots_.size(), kNoTexture);
  const auto renumber = [&](std::int32_t& map) {
    if (map == kNoTexture) return;
    const std::size_t slot = static_cast<std::size_t>(map);
    if (number[slot] == kNoTexture && slots_[slot]) {
      number[slot] = static_cast<std::int32_t>(scene.textures.size());
      scene.textures.push_back(std::move(*slots_[slot]));
    }
    map = number[slot];
  };
  for (Material& material : scene.materials) {
    renumber(material.diffuseMap);
    renumber(material.specularMap);
    renumber(material.roughnessMap);
    renumber(material.emissionMap);
    renumber(material.normalMap);
    renumber(material.alphaMap);
    renumber(material.coverageMap);
  }
}

}  // namespace whit
