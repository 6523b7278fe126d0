#include "io/gltf/baker.h"

#include <algorithm>
#include <array>

#include "core/srgb.h"
#include "io/image/image_decoders.h"
#include "io/image/texture_from_image.h"

namespace whit {
namespace {

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

}  // namespace

bool wantsBaked(const GltfMaterial& m, GltfBakedMap map) {
  const bool colored = m.baseMap.exists();
  return map == kGltfDiffuse ? m.mixesMetal() || (colored && m.metallic < 1)
                             : m.bakesSpecular() || (colored && m.metallic > 0);
}

GltfBaked bake(const GltfMaterial& material, const GltfBakeImages& images,
               const ImageLimits& limits, GltfMeans& means) {
  return Baker(material, images, limits).bake(means);
}

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

}  // namespace whit
