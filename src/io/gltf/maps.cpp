#include "io/gltf/maps.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <optional>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "core/srgb.h"
#include "io/image/image_decoders.h"
#include "io/image/texture_from_image.h"

namespace whit {

class GltfImage {
 public:
  GltfImage(const GltfImageSource& source, Warnings& warnings)
      : source_(source), warnings_(warnings) {}

  // Nothing: it cannot be read.
  std::shared_ptr<const RawImage> decode(const ImageLimits& limits) {
    const std::lock_guard lock(mutex_);
    if (broken_) return nullptr;
    if (auto raw = decoded_.lock()) return raw;
    try {
      auto raw = std::make_shared<const RawImage>(
          source_.path.empty() ? decodeRawImage(source_.where, source_.bytes, limits, warnings_)
                               : readRawImage(source_.path, limits, warnings_));
      decoded_ = raw;
      return raw;
    } catch (const Error& error) {
      if (error.status() == ExitStatus::limit) throw;
      broken_ = true;
      warnings_.add("texture left out", source_.where + ": " + error.what());
      return nullptr;
    }
  }

 private:
  const GltfImageSource& source_;
  Warnings& warnings_;
  std::mutex mutex_;
  std::weak_ptr<const RawImage> decoded_;
  bool broken_ = false;
};

namespace {

enum GltfBakedMap { kGltfDiffuse, kGltfSpecular, kGltfAlpha, kGltfBakedMaps };

// Decoded; null where there is none or it cannot be read, which counts as white.
struct GltfBakeImages {
  const RawImage* base = nullptr;
  const RawImage* metallicRoughness = nullptr;
  const RawImage* specular = nullptr;
  const RawImage* specularColor = nullptr;
};

// One for each GltfBakedMap that there is; the largest image's size, the others stretched to it.
using GltfBaked = std::vector<std::optional<Texture>>;

struct Texel {
  Rgb color;  // linear
  std::array<float, 4> code{1, 1, 1, 1};
};

// Nearest texels of an image that is stretched to another size; white without an image.
class Stretched {
 public:
  Stretched(const RawImage* raw, int width, int height)
      : raw_(raw), width_(width), height_(height) {}

  Texel at(int x, int y) const {
    Texel texel{Rgb(1.0f), {1, 1, 1, 1}};
    if (!raw_) return texel;
    const auto column = static_cast<std::size_t>(std::int64_t{x} * raw_->width / width_);
    const auto row = static_cast<std::size_t>(std::int64_t{y} * raw_->height / height_);
    const auto channels = static_cast<std::size_t>(raw_->channels);
    const std::size_t first = (row * static_cast<std::size_t>(raw_->width) + column) * channels;
    for (std::size_t c = 0; c < 4; ++c) {
      const bool color = c < 3, gray = channels < 3;
      if (!color && channels % 2 == 1) break;  // without alpha
      const std::size_t at = first + (gray ? (color ? 0 : 1) : c);
      texel.code[c] = raw_->linear ? raw_->values[at] : static_cast<float>(raw_->codes[at]) / 255;
      if (color) {
        texel.color[static_cast<int>(c)] =
            raw_->linear ? raw_->values[at] : linearOfCode(raw_->codes[at]);
      }
    }
    return texel;
  }

 private:
  const RawImage* raw_;
  int width_, height_;
};

// Means of codes, scaled to 0 to 1. A gray image has one mean for r, g and b; a missing alpha is 1.
struct ChannelMean {
  float mean = 0;
  bool varies = false;
};
ChannelMean meanOf(const RawImage& raw, std::size_t channel) {
  const Stretched texels(&raw, raw.width, raw.height);
  ChannelMean mean;
  const float first = texels.at(0, 0).code[channel];
  double sum = 0;
  for (int y = 0; y < raw.height; ++y) {
    for (int x = 0; x < raw.width; ++x) {
      const float value = texels.at(x, y).code[channel];
      sum += value;
      mean.varies = mean.varies || value != first;
    }
  }
  mean.mean =
      mean.varies ? static_cast<float>(sum / (static_cast<double>(raw.width) * raw.height)) : first;
  return mean;
}

// Tests the maps of diffuse and specular. The need for an alpha map follows from the image.
bool wantsBaked(const GltfMaterial& m, GltfBakedMap map) {
  const bool colored = m.baseMap.exists();
  return map == kGltfDiffuse ? m.mixesMetal() || (colored && m.metallic < 1)
                             : m.bakesSpecular() || (colored && m.metallic > 0);
}

// Throws Error(limit) where the textures are larger than the limits allow.
class Baker {
 public:
  Baker(const GltfMaterial& material, const GltfBakeImages& images, const ImageLimits& limits)
      : material_(material), limits_(limits), rawBase_(images.base) {
    for (const RawImage* raw :
         {images.base, images.metallicRoughness, images.specular, images.specularColor}) {
      if (!raw) continue;
      width_ = std::max(width_, raw->width);
      height_ = std::max(height_, raw->height);
    }
    held_ = holdImage(material.where, width_, height_, 2 * sizeof(std::uint32_t), limits);
    base_.emplace(images.base, width_, height_);
    metal_.emplace(images.metallicRoughness, width_, height_);
    specular_.emplace(images.specular, width_, height_);
    specularColor_.emplace(images.specularColor, width_, height_);
  }

  GltfBaked bake(GltfMeans& means) {
    GltfBaked maps(kGltfBakedMaps);
    for (const GltfBakedMap map : {kGltfDiffuse, kGltfSpecular}) {
      if (!wantsBaked(material_, map)) continue;
      maps[map].emplace();
      const bool emits = material_.unlit && map == kGltfDiffuse && rawBase_;
      start(*maps[map], emits ? emissionFormat(*rawBase_) : TexelFormat::color);
    }
    sum(maps);
    const double texels = static_cast<double>(width_) * height_;
    means.base = Rgb(color_ / texels);
    means.metallic = static_cast<float>(metallic_ / texels);
    means.roughness = static_cast<float>(roughness_ / texels);
    means.specular = static_cast<float>(strength_ / texels);
    means.specularColor = Rgb(tint_ / texels);
    if (rawBase_ && hasTranslucentAlpha(*rawBase_)) bakeAlpha(maps[kGltfAlpha], means);
    return maps;
  }

 private:
  void start(Texture& texture, TexelFormat format) const {
    const GltfTexture& map = material_.surfaceMap();
    texture.name = material_.name;
    texture.format = format;
    texture.wrapU = map.wrapU;
    texture.wrapV = map.wrapV;
    texture.width = width_;
    texture.height = height_;
    texture.texels.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  }

  void sum(GltfBaked& maps) {
    const bool mixes = material_.mixesMetal(), whole = material_.bakesSpecular();
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        const Texel base = base_->at(x, y), other = metal_->at(x, y);
        const float metal = material_.metallic * other.code[2];
        const float strength = specular_->at(x, y).code[3];
        const Rgb tint = specularColor_->at(x, y).color;
        color_ += RgbD(base.color);
        metallic_ += other.code[2];
        roughness_ += other.code[1];
        strength_ += strength;
        tint_ += RgbD(tint);
        if (maps[kGltfDiffuse]) {
          const Rgb diffuse = mixes ? base.color * (1 - metal) : base.color;
          maps[kGltfDiffuse]->texels.push_back(encodeTexel(diffuse, maps[kGltfDiffuse]->format));
        }
        if (!maps[kGltfSpecular]) continue;
        const Rgb f0 =
            whole ? material_.f0(tint, strength) * (1 - metal) + material_.base * base.color * metal
                  : base.color;
        maps[kGltfSpecular]->texels.push_back(encodeColorTexel(f0));
      }
    }
  }

  void bakeAlpha(std::optional<Texture>& map, GltfMeans& means) const {
    if (material_.alphaMode == GltfMaterial::Alpha::opaque) return;
    const ChannelMean alpha = meanOf(*rawBase_, 3);
    if (material_.alphaMode == GltfMaterial::Alpha::blend) {
      means.alphaByMap = alpha.varies;
      if (!alpha.varies) {
        means.alpha = alpha.mean;
        return;
      }
    }
    // The texture, and the channel that it is made from.
    const MemoryHold held = holdImage(material_.where, rawBase_->width, rawBase_->height,
                                      sizeof(std::uint32_t) + sizeof(float), limits_);
    map = makeTexture(material_.name, alphaOf(*rawBase_), TexelFormat::data);
    map->wrapU = material_.baseMap.wrapU;
    map->wrapV = material_.baseMap.wrapV;
  }

  const GltfMaterial& material_;
  const ImageLimits& limits_;
  const RawImage* rawBase_;
  int width_ = 1, height_ = 1;
  MemoryHold held_;  // of diffuse and specular
  std::optional<Stretched> base_, metal_, specular_, specularColor_;
  RgbD color_, tint_;
  double metallic_ = 0, roughness_ = 0, strength_ = 0;
};

using Images = std::vector<std::optional<Texture>>;

Texture normalTexture(const GltfMaterial& material, const RawImage& raw) {
  Texture texture = makeTexture(material.name, raw, TexelFormat::data);
  texture.wrapU = material.normalMap.wrapU;
  texture.wrapV = material.normalMap.wrapV;
  if (material.normalScale == 1) return texture;
  for (std::uint32_t& texel : texture.texels) {
    const auto channel = [&](int shift) {
      return static_cast<float>(texel >> shift & 255u) / 127.5f - 1;
    };
    const Vec3f n = normalized(
        Vec3f{channel(0) * material.normalScale, channel(8) * material.normalScale, channel(16)},
        Vec3f{0, 0, 1});
    texel = encodeDataTexel(n.x * 0.5f + 0.5f, n.y * 0.5f + 0.5f, n.z * 0.5f + 0.5f, 1);
  }
  return texture;
}

Texture emissionTexture(const GltfMaterial& material, const RawImage& raw, Warnings& warnings) {
  Texture texture = makeEmissionTexture(material.name, raw, warnings);
  texture.wrapU = material.emissiveMap.wrapU;
  texture.wrapV = material.emissiveMap.wrapV;
  return texture;
}

std::shared_ptr<const RawImage> decoded(const std::shared_ptr<GltfImage>& image,
                                        const ImageLimits& limits) {
  return image ? image->decode(limits) : nullptr;
}

// All that the maps and their means depend on.
std::string keyOf(const GltfMaterial& m) {
  std::ostringstream key;
  for (const GltfTexture* map :
       {&m.baseMap, &m.metallicRoughnessMap, &m.normalMap, &m.emissiveMap, &m.specularMap,
        &m.specularColorMap, &m.transmissionMap, &m.clearcoatMap, &m.clearcoatRoughnessMap}) {
    key << (map->image ? static_cast<std::int64_t>(*map->image) : -1) << ' '
        << static_cast<int>(map->wrapU) << static_cast<int>(map->wrapV) << ' ';
  }
  key << std::hexfloat << m.normalScale << ' ' << static_cast<int>(m.alphaMode) << ' '
      << (m.transmission > 0) << (m.clearcoat > 0) << m.emitsByMap() << m.unlit << ' ' << m.metallic
      << ' ' << m.variesRoughness() << ' ';
  if (m.bakesSpecular()) {
    key << m.f90 << ' ';
    for (int i = 0; i < 3; ++i) key << m.specularColor[i] << ' ' << m.base[i] << ' ';
  }
  return key.str();
}

}  // namespace

GltfMapMaker::GltfMapMaker(const GltfDocument& document) : warnings_(document.warnings()) {
  for (const GltfImageSource& source : document.images()) {
    images_.push_back(std::make_shared<GltfImage>(source, document.warnings()));
  }
}

GltfMapMaker::~GltfMapMaker() = default;

std::shared_ptr<GltfImage> GltfMapMaker::image(const GltfTexture& map) const {
  return map.image ? images_[*map.image] : nullptr;
}

GltfMaps GltfMapMaker::ask(const GltfMaterial& m, TextureLoader& textures) {
  const auto [entry, isNew] = known_.try_emplace(keyOf(m));
  GltfMaps& maps = entry->second;
  if (!isNew) return maps;
  const auto means = std::make_shared<GltfMeans>();
  maps.means = means;
  if (m.baseMap.exists() || m.metallicRoughnessMap.exists() || m.variesF0()) {
    const auto slots = textures.add(
        kGltfBakedMaps, [=, base = image(m.baseMap), metal = image(m.metallicRoughnessMap),
                         strength = image(m.specularMap), tint = image(m.specularColorMap),
                         &textures, &warnings = warnings_] {
          const ImageLimits limits = textures.limits();
          const auto rawBase = decoded(base, limits), rawMetal = decoded(metal, limits);
          const auto rawStrength = decoded(strength, limits), rawTint = decoded(tint, limits);
          for (const RawImage* color : {m.unlit ? nullptr : rawBase.get(), rawTint.get()}) {
            if (color) warnOfClampedColors(m.where, *color, warnings);
          }
          const GltfBakeImages all{rawBase.get(), rawMetal.get(), rawStrength.get(), rawTint.get()};
          return Baker(m, all, limits).bake(*means);
        });
    if (wantsBaked(m, kGltfDiffuse)) (m.unlit ? maps.emission : maps.diffuse) = slots[kGltfDiffuse];
    if (wantsBaked(m, kGltfSpecular)) maps.specular = slots[kGltfSpecular];
    if (m.alphaMode != GltfMaterial::Alpha::opaque) maps.alpha = slots[kGltfAlpha];
    if (m.alphaMode == GltfMaterial::Alpha::blend) maps.coverage = slots[kGltfAlpha];
  }
  const auto single = [&](const GltfTexture& map, const auto& make) {
    return textures.add(1, [=, image = image(map), &textures] {
      const ImageLimits limits = textures.limits();
      const auto raw = decoded(image, limits);
      Images made(1);
      if (!raw) return made;
      const MemoryHold held =
          holdImage(m.where, raw->width, raw->height, sizeof(std::uint32_t), limits);
      made[0] = make(m, *raw);
      return made;
    })[0];
  };
  const auto emissive = [&warnings = warnings_](const GltfMaterial& from, const RawImage& raw) {
    return emissionTexture(from, raw, warnings);
  };
  if (m.normalMap.exists()) maps.normal = single(m.normalMap, normalTexture);
  if (m.variesRoughness()) maps.roughness = roughnessOf(m, means, textures);
  if (m.emitsByMap()) maps.emission = single(m.emissiveMap, emissive);
  addMeans(m, means, textures);
  return maps;
}

// A slot that stays empty where the texels do not differ.
std::int32_t GltfMapMaker::roughnessOf(const GltfMaterial& m,
                                       const std::shared_ptr<GltfMeans>& means,
                                       TextureLoader& textures) const {
  return textures.add(1, [=, image = image(m.metallicRoughnessMap), &textures] {
    const ImageLimits limits = textures.limits();
    const auto raw = decoded(image, limits);
    Images made(1);
    if (!raw || !meanOf(*raw, 1).varies) return made;
    const MemoryHold held =
        holdImage(m.where, raw->width, raw->height, sizeof(std::uint32_t), limits);
    made[0] = makeTexture(m.name, *raw, TexelFormat::data);
    made[0]->wrapU = m.metallicRoughnessMap.wrapU;
    made[0]->wrapV = m.metallicRoughnessMap.wrapV;
    means->roughnessByMap = true;
    return made;
  })[0];
}

// Multiplies means into factors that have no map in a Material.
void GltfMapMaker::addMeans(const GltfMaterial& m, const std::shared_ptr<GltfMeans>& means,
                            TextureLoader& textures) const {
  const auto add = [&](const GltfTexture& map, std::size_t channel, float GltfMeans::*mean,
                       const char* warning) {
    if (!map.exists()) return;
    textures.add(0, [=, this, image = image(map), where = m.where, &textures] {
      if (const auto raw = decoded(image, textures.limits())) {
        const ChannelMean found = meanOf(*raw, channel);
        (*means).*mean = found.mean;
        if (found.varies) warnings_.add(warning, where);
      }
      return Images();
    });
  };
  if (m.transmission > 0) {
    add(m.transmissionMap, 0, &GltfMeans::transmission,
        "transmission by a texture taken by its mean");
  }
  if (m.clearcoat > 0) {
    add(m.clearcoatMap, 0, &GltfMeans::clearcoat, "clearcoat by a texture taken by its mean");
    add(m.clearcoatRoughnessMap, 1, &GltfMeans::clearcoatRoughness,
        "roughness of a clearcoat by a texture taken by its mean");
  }
}

}  // namespace whit
