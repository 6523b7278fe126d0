#include "io/gltf/maps.h"

#include <mutex>
#include <optional>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "io/gltf/baker.h"
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
          return bake(m, {rawBase.get(), rawMetal.get(), rawStrength.get(), rawTint.get()}, limits,
                      *means);
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
