#include "io/gltf_maps.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <optional>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "io/image_decoders.h"
#include "io/image_file.h"
#include "io/raw_channels.h"

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
          source_.path.empty()
              ? decodeRawImage(source_.where, {source_.bytes.begin(), source_.bytes.end()}, limits,
                               warnings_)
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
enum Map { kDiffuse, kSpecular, kAlpha, kMaps };

struct Texel {
  Rgb colour;  // linear
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
      const bool colour = c < 3, grey = channels < 3;
      if (!colour && channels % 2 == 1) break;  // without alpha
      const std::size_t at = first + (grey ? (colour ? 0 : 1) : c);
      texel.code[c] = raw_->linear ? raw_->values[at] : static_cast<float>(raw_->codes[at]) / 255;
      if (colour) {
        texel.colour[static_cast<int>(c)] =
            raw_->linear ? raw_->values[at] : linearOfCode()[raw_->codes[at]];
      }
    }
    return texel;
  }

 private:
  const RawImage* raw_;
  int width_, height_;
};

// What base colour and metalness become together.
class Baker {
 public:
  Baker(const GltfMaterial& material, const RawImage* base, const RawImage* metal,
        const ImageLimits& limits)
      : material_(material), rawBase_(base) {
    for (const RawImage* raw : {base, metal}) {
      if (!raw) continue;
      width_ = std::max(width_, raw->width);
      height_ = std::max(height_, raw->height);
    }
    constexpr std::uint64_t kBytesPerTexel = 2 * sizeof(std::uint32_t);
    checkImageSize(material.where, width_, height_, kBytesPerTexel, limits);
    base_.emplace(base, width_, height_);
    metal_.emplace(metal, width_, height_);
  }

  Images bake(GltfMeans& means) {
    Images maps(kMaps);
    for (const Map map : {kDiffuse, kSpecular}) {
      if (!wants(map)) continue;
      maps[map].emplace();
      start(*maps[map], TexelFormat::colour);
    }
    sum(maps);
    const double texels = static_cast<double>(width_) * height_;
    means.base = Rgb(colour_ / texels);
    means.metallic = static_cast<float>(metallic_ / texels);
    means.roughness = static_cast<float>(roughness_ / texels);
    if (rawBase_ && hasTranslucentAlpha(*rawBase_)) bakeAlpha(maps[kAlpha], means);
    return maps;
  }

  static bool wants(const GltfMaterial& m, Map map) {
    const bool mixes = m.mixesMetal();
    return map == kDiffuse ? mixes || (m.baseMap.exists() && m.metallic < 1)
                           : mixes || (m.baseMap.exists() && m.metallic > 0);
  }

 private:
  bool wants(Map map) const { return wants(material_, map); }

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

  void sum(Images& maps) {
    const bool mixes = material_.mixesMetal();
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        const Texel base = base_->at(x, y), other = metal_->at(x, y);
        const float metal = mixes ? material_.metallic * other.code[2] : 0.0f;
        colour_ += RgbD(base.colour);
        metallic_ += other.code[2];
        roughness_ += other.code[1];
        if (maps[kDiffuse]) {
          maps[kDiffuse]->texels.push_back(encodeColourTexel(base.colour * (1 - metal)));
        }
        if (!maps[kSpecular]) continue;
        const Rgb f0 =
            mixes ? material_.f0 * (1 - metal) + material_.base * base.colour * metal : base.colour;
        maps[kSpecular]->texels.push_back(encodeColourTexel(f0));
      }
    }
  }

  // Blending is even where most of what is not opaque is not clear either.
  void bakeAlpha(std::optional<Texture>& map, GltfMeans& means) const {
    if (material_.alphaMode == GltfMaterial::Alpha::opaque) return;
    double alpha = 0;
    std::uint64_t between = 0, translucent = 0;
    for (int y = 0; y < rawBase_->height; ++y) {
      for (int x = 0; x < rawBase_->width; ++x) {
        const float a = Stretched(rawBase_, rawBase_->width, rawBase_->height).at(x, y).code[3];
        alpha += a;
        translucent += a < 1;
        between += a > 0.1f && a < 0.9f;
      }
    }
    if (material_.alphaMode == GltfMaterial::Alpha::blend && 2 * between > translucent) {
      means.alpha =
          static_cast<float>(alpha / (static_cast<double>(rawBase_->width) * rawBase_->height));
      return;
    }
    map = makeTexture(material_.name, alphaOf(*rawBase_), TexelFormat::data);
    map->wrapU = material_.baseMap.wrapU;
    map->wrapV = material_.baseMap.wrapV;
  }

  const GltfMaterial& material_;
  const RawImage* rawBase_;
  int width_ = 1, height_ = 1;
  std::optional<Stretched> base_, metal_;
  RgbD colour_;
  double metallic_ = 0, roughness_ = 0;
};

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

float meanOfFirstChannel(const RawImage& raw) {
  const Stretched texels(&raw, raw.width, raw.height);
  double sum = 0;
  for (int y = 0; y < raw.height; ++y) {
    for (int x = 0; x < raw.width; ++x) sum += texels.at(x, y).code[0];
  }
  return static_cast<float>(sum / (static_cast<double>(raw.width) * raw.height));
}

Texture colourTexture(const GltfMaterial& material, const GltfTexture& map, const RawImage& raw) {
  Texture texture = makeTexture(material.name, raw, TexelFormat::colour);
  texture.wrapU = map.wrapU;
  texture.wrapV = map.wrapV;
  return texture;
}

// All that the maps and their means depend on.
std::string keyOf(const GltfMaterial& m) {
  std::ostringstream key;
  for (const GltfTexture* map :
       {&m.baseMap, &m.metallicRoughnessMap, &m.normalMap, &m.emissiveMap, &m.transmissionMap}) {
    key << map->image << ' ' << static_cast<int>(map->wrapU) << static_cast<int>(map->wrapV) << ' ';
  }
  key << std::hexfloat << m.normalScale << ' ' << static_cast<int>(m.alphaMode) << ' '
      << (m.transmission > 0) << m.emitsByMap() << m.unlit << ' ' << m.metallic << ' ';
  if (m.mixesMetal()) {
    for (int i = 0; i < 3; ++i) key << m.f0[i] << ' ' << m.base[i] << ' ';
  }
  return key.str();
}

}  // namespace

GltfMapMaker::GltfMapMaker(const GltfDocument& document) {
  for (const GltfImageSource& source : document.images()) {
    images_.push_back(std::make_shared<GltfImage>(source, document.warnings()));
  }
}

GltfMapMaker::~GltfMapMaker() = default;

std::shared_ptr<GltfImage> GltfMapMaker::image(const GltfTexture& map) const {
  return map.exists() ? images_[static_cast<std::size_t>(map.image)] : nullptr;
}

GltfMaps GltfMapMaker::ask(const GltfMaterial& m, TextureLoader& textures) {
  const auto [entry, isNew] = known_.try_emplace(keyOf(m));
  GltfMaps& maps = entry->second;
  if (!isNew) return maps;
  const auto means = std::make_shared<GltfMeans>();
  maps.means = means;
  const auto decode = [&textures](const std::shared_ptr<GltfImage>& image) {
    return image ? image->decode(textures.limits()) : nullptr;
  };
  if (m.baseMap.exists() || m.metallicRoughnessMap.exists()) {
    const auto slots = textures.add(
        kMaps, [=, base = image(m.baseMap), metal = image(m.metallicRoughnessMap), &textures] {
          const auto rawBase = decode(base), rawMetal = decode(metal);
          return Baker(m, rawBase.get(), rawMetal.get(), textures.limits()).bake(*means);
        });
    if (Baker::wants(m, kDiffuse)) (m.unlit ? maps.emission : maps.diffuse) = slots[kDiffuse];
    if (Baker::wants(m, kSpecular)) maps.specular = slots[kSpecular];
    if (m.alphaMode != GltfMaterial::Alpha::opaque) maps.alpha = slots[kAlpha];
  }
  if (m.normalMap.exists()) {
    maps.normal = textures.add(1, [=, normal = image(m.normalMap)] {
      const auto raw = decode(normal);
      Images made(1);
      if (raw) made[0] = normalTexture(m, *raw);
      return made;
    })[0];
  }
  if (m.emitsByMap()) {
    maps.emission = textures.add(1, [=, emissive = image(m.emissiveMap)] {
      const auto raw = decode(emissive);
      Images made(1);
      if (raw) made[0] = colourTexture(m, m.emissiveMap, *raw);
      return made;
    })[0];
  }
  if (m.transmission > 0 && m.transmissionMap.exists()) {
    textures.add(0, [=, map = image(m.transmissionMap)] {
      if (const auto raw = decode(map)) means->transmission = meanOfFirstChannel(*raw);
      return Images();
    });
  }
  return maps;
}

}  // namespace whit
