// Textures made from glTF's images: reflectance, holes, normals, emission.
#include <algorithm>
#include <array>
#include <mutex>
#include <optional>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "core/srgb.h"
#include "io/gltf/material.h"
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

using Images = std::vector<std::optional<Texture>>;

enum GltfBakedMap { kGltfDiffuse, kGltfSpecular, kGltfAlpha, kGltfBakedMaps };

// Decoded; null where there is none or it cannot be read, which counts as white.
struct GltfBakeImages {
  std::shared_ptr<const RawImage> base, metallicRoughness, specular, specularColor;
};

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

Texture emptyTexture(const GltfMaterial& material, TexelFormat format, int width, int height) {
  Texture texture;
  texture.name = material.name;
  texture.format = format;
  texture.wrapU = material.surfaceMap().wrapU;
  texture.wrapV = material.surfaceMap().wrapV;
  texture.width = width;
  texture.height = height;
  texture.texels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  return texture;
}

// The texture of the alpha channel, or none where it has the same value everywhere.
std::optional<Texture> bakeAlpha(const GltfMaterial& m, const RawImage& raw,
                                 const ImageLimits& limits, GltfMeans& means) {
  if (m.alphaMode == GltfMaterial::Alpha::opaque || !hasTranslucentAlpha(raw)) return {};
  if (m.alphaMode == GltfMaterial::Alpha::blend) {
    const ChannelMean alpha = meanOf(raw, 3);
    means.alphaByMap = alpha.varies;
    if (!alpha.varies) {
      means.alpha = alpha.mean;
      return {};
    }
  }
  // The texture, and the channel that it is made from.
  const MemoryHold held =
      holdImage(m.where, raw.width, raw.height, sizeof(std::uint32_t) + sizeof(float), limits);
  Texture texture = makeTexture(m.name, alphaOf(raw), TexelFormat::data);
  texture.wrapU = m.baseMap.wrapU;
  texture.wrapV = m.baseMap.wrapV;
  return texture;
}

// One texture for each GltfBakedMap that there is; the largest image's size, the others stretched
// to it. Throws Error(limit) where the textures are larger than the limits allow.
Images bake(const GltfMaterial& m, const GltfBakeImages& images, const ImageLimits& limits,
            GltfMeans& means) {
  int width = 1, height = 1;
  for (const auto& raw :
       {images.base, images.metallicRoughness, images.specular, images.specularColor}) {
    width = std::max(width, raw ? raw->width : 1);
    height = std::max(height, raw ? raw->height : 1);
  }
  const MemoryHold held = holdImage(m.where, width, height, 2 * sizeof(std::uint32_t), limits);
  const Stretched bases(images.base.get(), width, height);
  const Stretched metals(images.metallicRoughness.get(), width, height);
  const Stretched speculars(images.specular.get(), width, height);
  const Stretched tints(images.specularColor.get(), width, height);
  Images maps(kGltfBakedMaps);
  if (wantsBaked(m, kGltfDiffuse)) {
    const bool emits = m.unlit && images.base;
    maps[kGltfDiffuse] =
        emptyTexture(m, emits ? emissionFormat(*images.base) : TexelFormat::color, width, height);
  }
  if (wantsBaked(m, kGltfSpecular)) {
    maps[kGltfSpecular] = emptyTexture(m, TexelFormat::color, width, height);
  }
  RgbD colors, tintSum;
  double metallic = 0, roughness = 0, strengths = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Rgb base = bases.at(x, y).color, tint = tints.at(x, y).color;
      const Texel other = metals.at(x, y);
      const float metal = m.metallic * other.code[2], strength = speculars.at(x, y).code[3];
      colors += RgbD(base);
      metallic += other.code[2];
      roughness += other.code[1];
      strengths += strength;
      tintSum += RgbD(tint);
      if (maps[kGltfDiffuse]) {
        const Rgb diffuse = m.mixesMetal() ? base * (1 - metal) : base;
        maps[kGltfDiffuse]->texels.push_back(encodeTexel(diffuse, maps[kGltfDiffuse]->format));
      }
      if (!maps[kGltfSpecular]) continue;
      const Rgb f0 =
          m.bakesSpecular() ? m.f0(tint, strength) * (1 - metal) + m.base * base * metal : base;
      maps[kGltfSpecular]->texels.push_back(encodeColorTexel(f0));
    }
  }
  const double texels = static_cast<double>(width) * height;
  means.base = Rgb(colors / texels);
  means.metallic = static_cast<float>(metallic / texels);
  means.roughness = static_cast<float>(roughness / texels);
  means.specular = static_cast<float>(strengths / texels);
  means.specularColor = Rgb(tintSum / texels);
  if (images.base) maps[kGltfAlpha] = bakeAlpha(m, *images.base, limits, means);
  return maps;
}

Texture normalTexture(const GltfMaterial& material, const RawImage& raw) {
  Texture texture = makeTexture(material.name, raw, TexelFormat::data);
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

GltfMaps GltfMapMaker::ask(const GltfMaterial& m, TextureLoader& textures) {
  const auto [entry, isNew] = known_.try_emplace(keyOf(m));
  GltfMaps& maps = entry->second;
  if (!isNew) return maps;
  const auto means = std::make_shared<GltfMeans>();
  maps.means = means;
  Warnings& warnings = warnings_;
  const auto image = [&](const GltfTexture& map) {
    return map.image ? images_[*map.image] : nullptr;
  };
  if (m.baseMap.exists() || m.metallicRoughnessMap.exists() || m.variesF0()) {
    const auto slots = textures.add(kGltfBakedMaps, [=, base = image(m.baseMap),
                                                     metal = image(m.metallicRoughnessMap),
                                                     strength = image(m.specularMap),
                                                     tint = image(m.specularColorMap), &textures,
                                                     &warnings] {
      const ImageLimits limits = textures.limits();
      const GltfBakeImages all{decoded(base, limits), decoded(metal, limits),
                               decoded(strength, limits), decoded(tint, limits)};
      for (const RawImage* color : {m.unlit ? nullptr : all.base.get(), all.specularColor.get()}) {
        if (color) warnOfClampedColors(m.where, *color, warnings);
      }
      return bake(m, all, limits, *means);
    });
    if (wantsBaked(m, kGltfDiffuse)) (m.unlit ? maps.emission : maps.diffuse) = slots[kGltfDiffuse];
    if (wantsBaked(m, kGltfSpecular)) maps.specular = slots[kGltfSpecular];
    if (m.alphaMode != GltfMaterial::Alpha::opaque) maps.alpha = slots[kGltfAlpha];
    if (m.alphaMode == GltfMaterial::Alpha::blend) maps.coverage = slots[kGltfAlpha];
  }
  // A texture that `make` makes from one image; it may make none.
  const auto single = [&](const GltfTexture& map, const auto& make) {
    return textures.add(1, [=, image = image(map), where = m.where, &textures] {
      const ImageLimits limits = textures.limits();
      Images made(1);
      const auto raw = decoded(image, limits);
      if (!raw) return made;
      const MemoryHold held =
          holdImage(where, raw->width, raw->height, sizeof(std::uint32_t), limits);
      made[0] = make(*raw);
      if (!made[0]) return made;
      made[0]->wrapU = map.wrapU;
      made[0]->wrapV = map.wrapV;
      return made;
    })[0];
  };
  if (m.normalMap.exists()) {
    maps.normal = single(m.normalMap, [m](const RawImage& raw) { return normalTexture(m, raw); });
  }
  if (m.variesRoughness()) {
    maps.roughness = single(m.metallicRoughnessMap, [=](const RawImage& raw) {
      means->roughnessByMap = meanOf(raw, 1).varies;
      return means->roughnessByMap ? std::optional(makeTexture(m.name, raw, TexelFormat::data))
                                   : std::nullopt;
    });
  }
  if (m.emitsByMap()) {
    maps.emission = single(m.emissiveMap, [name = m.name, &warnings](const RawImage& raw) {
      return makeEmissionTexture(name, raw, warnings);
    });
  }
  // The mean of a channel is multiplied into a factor that has no map in a Material.
  const auto mean = [&](const GltfTexture& map, std::size_t channel, float GltfMeans::*to,
                        const char* warning) {
    if (!map.exists()) return;
    textures.add(0, [=, image = image(map), where = m.where, &textures, &warnings] {
      if (const auto raw = decoded(image, textures.limits())) {
        const ChannelMean found = meanOf(*raw, channel);
        (*means).*to = found.mean;
        if (found.varies) warnings.add(warning, where);
      }
      return Images();
    });
  };
  if (m.transmission > 0) {
    mean(m.transmissionMap, 0, &GltfMeans::transmission,
         "transmission by a texture taken by its mean");
  }
  if (m.clearcoat > 0) {
    mean(m.clearcoatMap, 0, &GltfMeans::clearcoat, "clearcoat by a texture taken by its mean");
    mean(m.clearcoatRoughnessMap, 1, &GltfMeans::clearcoatRoughness,
         "roughness of a clearcoat by a texture taken by its mean");
  }
  return maps;
}

}  // namespace whit
