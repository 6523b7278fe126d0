// Textures made from glTF's images: reflectance, holes, normals, emission.
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numeric>
#include <optional>
#include <sstream>

#include "core/error.h"
#include "core/index.h"
#include "io/gltf/material.h"
#include "io/image/image_decoders.h"
#include "io/image/texture_from_image.h"
#include "scene/members.h"

namespace whit {

class GltfImage {
 public:
  GltfImage(const GltfImageSource& source, Warnings& warnings)
      : source_(source), warnings_(warnings) {}

  // Returns null where the image cannot be read.
  std::shared_ptr<const RawImage> decode(const ImageLimits& limits) {
    const std::lock_guard lock(mutex_);
    if (broken_) return nullptr;

    // Textures that are made at the same time share one decoded image.
    if (auto raw = decoded_.lock()) return raw;

    try {
      if (source_.error) std::rethrow_exception(source_.error);
      auto raw = std::make_shared<const RawImage>(
          source_.path.empty() ? decodeRawImage(source_.where, source_.bytes, limits, warnings_)
                               : readStraightImage(source_.path, limits, warnings_));
      decoded_ = raw;
      return raw;
    } catch (const Error& error) {
      // A damaged image leaves out its textures; too little memory is an error.
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

enum GltfBakedMap { kGltfDiffuse, kGltfSpecular, kGltfTransmission, kGltfAlpha, kGltfBakedMaps };

// Names the images that are baked together. An image is null where there is none or it cannot be
// read; it counts as white then.
enum GltfBakeImage {
  kBase,
  kMetallicRoughness,
  kSpecular,
  kSpecularColor,
  kTransmission,
  kBakeImages
};
using GltfBakeImages = std::array<std::shared_ptr<const RawImage>, kBakeImages>;

// Textures of a GltfMaterial by GltfBakeImage.
constexpr GltfTexture GltfMaterial::*kBakeMaps[kBakeImages] = {
    &GltfMaterial::baseMap, &GltfMaterial::metallicRoughnessMap, &GltfMaterial::specularMap,
    &GltfMaterial::specularColorMap, &GltfMaterial::transmissionMap};

// Two neighboring texels of a row or column, and the weight of the second.
struct Between {
  int first, second;
  float weight;
};

// Positions, in texels, that differ by at most this are equal: rounding has moved one of them.
constexpr double kTexelRounding = 1e-3;

// Resamples a row of texels: `count` texels show it `times` times, from `begin` on.
std::vector<Between> resample(int texels, double count, double times, double begin, Wrap wrap,
                              bool nearest) {
  const auto wrapped = [=](double texel) {
    return wrapTexel(static_cast<int>(texel), texels, wrap);
  };

  std::vector<Between> shown;
  for (const auto i : indices(static_cast<std::size_t>(count))) {
    const double place = times * (static_cast<double>(i) + 0.5) / count + begin;
    const double inImage = std::min(place - std::floor(place), 1 - 1e-9);  // below 1

    // Centers of texels lie at half-integers. Close to one of them its texel is shown alone.
    const double center = inImage * texels - 0.5;
    const double first = std::floor(center + (nearest ? 0.5 : kTexelRounding));
    const double weight = center - first;
    const bool isAlone = nearest || weight < kTexelRounding;
    shown.push_back({wrapped(first), wrapped(first + 1), static_cast<float>(isAlone ? 0 : weight)});
  }
  return shown;
}

// `read` returns the value of a texel.
template <typename Read>
auto blend(const RawImage& raw, const Between& column, const Between& row, const Read& read) {
  const auto along = [&](int line) {
    const std::size_t begin = cellsOf(line, raw.width);
    const auto first = read(begin + column.first);
    if (column.weight == 0) return first;
    return first + (read(begin + column.second) - first) * column.weight;
  };

  const auto upper = along(row.first);
  if (row.weight == 0) return upper;
  return upper + (along(row.second) - upper) * row.weight;
}

// An image that is stretched to another size; white without an image.
class Stretched {
 public:
  Stretched() = default;
  Stretched(const RawImage* raw, std::vector<Between> columns, std::vector<Between> rows)
      : raw_(raw), columns_(std::move(columns)), rows_(std::move(rows)) {}

  // Fill a row of white texels with linear colors, or with a channel; see valueAt().
  void fillColors(std::size_t y, std::vector<Rgb>& row) const {
    fill(y, row, [this](std::size_t i) { return linearPixel(*raw_, i); });
  }
  void fillValues(std::size_t y, std::size_t channel, std::vector<float>& row) const {
    fill(y, row, [=, this](std::size_t i) { return valueAt(*raw_, i, channel); });
  }

 private:
  template <typename Value, typename Read>
  void fill(std::size_t y, std::vector<Value>& row, const Read& read) const {
    if (!raw_) return;
    for (const auto x : indices(row)) row[x] = blend(*raw_, columns_[x], rows_[y], read);
  }

  const RawImage* raw_ = nullptr;
  std::vector<Between> columns_, rows_;
};

// Holds the mean of a channel, which valueAt() reads, and whether its pixels differ.
struct ChannelMean {
  float mean = 0;
  bool varies = false;
};
ChannelMean meanOf(const RawImage& raw, std::size_t channel) {
  const float first = valueAt(raw, 0, channel);
  ChannelMean result{first};
  double sum = 0;

  for (const auto i : indices(raw.pixels())) {
    const float value = valueAt(raw, i, channel);
    sum += value;
    result.varies = result.varies || value != first;
  }

  if (result.varies) result.mean = static_cast<float>(sum / static_cast<double>(raw.pixels()));
  return result;
}

// Returns the mean of the linear colors.
Rgb meanColor(const RawImage& raw) {
  RgbD sum;
  for (const auto i : indices(raw.pixels())) sum += RgbD(linearPixel(raw, i));
  return Rgb(sum / static_cast<double>(raw.pixels()));
}

// Masks of foliage have soft edges, which take less than half of their texels, and codes near 0 and
// 1 after JPEG. With more gray texels a map means how much of the surface is there.
bool isMostlyGray(const RawImage& raw, std::size_t channel) {
  constexpr float kNoise = 16.0f / 255;
  std::size_t gray = 0;
  for (const auto i : indices(raw.pixels())) {
    const float value = valueAt(raw, i, channel);
    if (value > kNoise && value < 1 - kNoise) ++gray;
  }
  return gray > raw.pixels() / 2;
}

// Tests all but the alpha map, whose need follows from the image.
bool wantsBaked(const GltfMaterial& m, GltfBakedMap map) {
  const bool colored = m.baseMap.exists();
  if (map == kGltfTransmission) return m.bakesTransmission();
  if (map == kGltfSpecular) return m.bakesSpecular() || (colored && m.metallic > 0);
  return m.mixesMetal() || ((colored || m.variesTransmission()) && m.metallic < 1);
}

void setSampler(const GltfTexture& map, Texture& texture) {
  texture.wrapU = map.wrapU;
  texture.wrapV = map.wrapV;
  texture.nearest = map.nearest;
}

// Makes the texture of an image's alpha channel, or none where it has the same value everywhere.
std::optional<Texture> alphaOfImage(const GltfMaterial& m, const RawImage& raw,
                                    const ImageLimits& limits, GltfMeans& means) {
  const bool isUsed = m.alphaMode != GltfMaterial::Alpha::opaque && !m.maskMap.exists();
  if (!isUsed || !hasTranslucentAlpha(raw)) return {};

  // An alpha that is the same everywhere is a factor and needs no texture.
  if (m.alphaMode == GltfMaterial::Alpha::blend) {
    const ChannelMean alpha = meanOf(raw, 3);
    means.alphaByMap = alpha.varies;
    if (!alpha.varies) {
      means.alpha = alpha.mean;
      return {};
    }
  }

  means.maskBlends = m.maskMayBlend && isMostlyGray(raw, 3);
  const MemoryHold held = holdImage(m.where, raw.width, raw.height, sizeof(std::uint32_t), limits);
  Texture texture = makeAlphaTexture(m.name, raw);
  setSampler(m.baseMap, texture);
  return texture;
}

// The alpha of vertices multiplies a map, which is opaque if the image is.
std::optional<Texture> bakeAlpha(const GltfMaterial& m, const RawImage* base,
                                 const ImageLimits& limits, GltfMeans& means) {
  std::optional<Texture> alpha;
  if (base) alpha = alphaOfImage(m, *base, limits, means);
  if (!m.multipliesAlpha()) return alpha;

  means.alphaByMap = true;
  if (!alpha) {
    alpha = emptyTexture(m.name, TexelFormat::data, 1, 1);
    alpha->texels = {encodeDataTexel(1, 1, 1, 1)};
  }
  return alpha;
}

// Returns a black texture for each GltfBakedMap that is needed, but for the alpha map.
Images emptyMaps(const GltfMaterial& m, const RawImage* base, const GltfTexture& sampler, int width,
                 int height) {
  Images maps(kGltfBakedMaps);
  const auto start = [&](GltfBakedMap map, TexelFormat format) {
    if (!wantsBaked(m, map)) return;
    maps[map] = emptyTexture(m.name, format, width, height);
    setSampler(sampler, *maps[map]);
  };

  // An unlit material emits its base color, which may exceed 1.
  start(kGltfDiffuse, m.unlit && base ? emissionFormat(*base) : TexelFormat::color);
  start(kGltfSpecular, TexelFormat::color);
  start(kGltfTransmission, TexelFormat::color);
  return maps;
}

// Returns the texels of a side that shows another image as well: a common multiple, which keeps all
// edges of texels that are not interpolated, or as many as the larger one has.
int sideOfBoth(int side, int texels) {
  constexpr int kMost = 1024;
  const int larger = std::max(side, texels);
  const auto common = std::lcm(std::int64_t{side}, texels);
  return common <= std::max(larger, kMost) ? static_cast<int>(common) : larger;
}

// Images that are stretched to one size and looked up with one sampler. Those that change nothing
// and a metalness that is the same everywhere have no influence on either.
struct BakedImages {
  int width = 1, height = 1;
  std::optional<GltfTexture> sampler;  // of the first that counts
  std::array<Stretched, kBakeImages> stretched;
};

BakedImages stretch(const GltfMaterial& m, const GltfBakeImages& images, bool metalVaries,
                    Warnings& warnings) {
  BakedImages baked;
  const bool f0 = m.bakesSpecular() && maxComponent(m.f0(Rgb(1.0f), 1)) > 0;
  const bool counts[] = {true, m.metallic > 0 && metalVaries, f0, f0, m.variesTransmission()};

  for (const auto i : indices(images)) {
    if (!images[i] || !counts[i]) continue;
    if (!baked.sampler) baked.sampler = m.*kBakeMaps[i];
    baked.width = sideOfBoth(baked.width, images[i]->width);
    baked.height = sideOfBoth(baked.height, images[i]->height);
  }

  for (const auto i : indices(images)) {
    const RawImage* const raw = images[i].get();
    const GltfTexture& own = m.*kBakeMaps[i];
    if (!raw) continue;
    baked.stretched[i] =
        Stretched(raw, resample(raw->width, baked.width, 1, 0, own.wrapU, own.nearest),
                  resample(raw->height, baked.height, 1, 0, own.wrapV, own.nearest));
    if (!counts[i]) continue;

    // Texels of what is baked cannot follow all edges of others, nor two samplers.
    const GltfTexture& used = *baked.sampler;
    const bool isSame =
        own.nearest == used.nearest && own.wrapU == used.wrapU && own.wrapV == used.wrapV;
    const int beyond = baked.width % raw->width + baked.height % raw->height;
    if (!isSame || (own.nearest && beyond > 0)) {
      warnings.add(
          "textures of one material have different samplers; that of the first is used for all",
          m.where);
    }
  }
  return baked;
}

// Makes one texture for each GltfBakedMap that is needed, from images that are stretched to one
// size. Throws Error(limit) where the textures are larger than the limits allow.
Images bake(const GltfMaterial& m, const GltfBakeImages& images, const ImageLimits& limits,
            Warnings& warnings, GltfMeans& means) {
  // Factors of the material follow from the means of the images.
  ChannelMean metalness{means.metallic};
  if (images[kMetallicRoughness]) metalness = meanOf(*images[kMetallicRoughness], 2);
  means.metallic = metalness.mean;
  if (images[kBase]) means.base = meanColor(*images[kBase]);
  if (images[kSpecular]) means.specular = meanOf(*images[kSpecular], 3).mean;
  if (images[kSpecularColor]) means.specularColor = meanColor(*images[kSpecularColor]);

  const BakedImages baked = stretch(m, images, metalness.varies, warnings);
  const auto& [bases, metals, speculars, tints, clears] = baked.stretched;
  const int width = baked.width, height = baked.height;
  const MemoryHold held = holdImage(m.where, width, height, 3 * sizeof(std::uint32_t), limits);
  Images maps = emptyMaps(m, images[kBase].get(), baked.sampler.value_or(m.baseMap), width, height);

  // A map that has the base color as it is takes it from an image of the same size, which is faster
  // than texel by texel.
  const RawImage* const own = images[kBase].get();
  const auto copiesBase = [&](GltfBakedMap map) {
    const bool isCopied = maps[map] && own && own->width == width && own->height == height;
    if (isCopied) maps[map]->texels = makeTexture(m.name, *own, maps[map]->format).texels;
    return isCopied;
  };
  std::optional<Texture>& diffuseMap = maps[kGltfDiffuse];
  std::optional<Texture>& specularMap = maps[kGltfSpecular];
  std::optional<Texture>& transmissionMap = maps[kGltfTransmission];
  const bool isDimmed = m.mixesMetal() || m.variesTransmission();
  const bool mixesDiffuse = diffuseMap && (isDimmed || !copiesBase(kGltfDiffuse));
  const bool mixesSpecular = specularMap && (m.bakesSpecular() || !copiesBase(kGltfSpecular));

  maps[kGltfAlpha] = bakeAlpha(m, images[kBase].get(), limits, means);
  if (!mixesDiffuse && !mixesSpecular && !transmissionMap) return maps;

  std::size_t i = 0;
  std::vector<Rgb> baseRow(width, Rgb(1.0f)), tintRow = baseRow;
  std::vector<float> metalRow(width, 1.0f), strengthRow = metalRow, clearRow = metalRow;

  for (const auto y : indices(height)) {
    bases.fillColors(y, baseRow);
    tints.fillColors(y, tintRow);
    metals.fillValues(y, 2, metalRow);
    speculars.fillValues(y, 3, strengthRow);
    clears.fillValues(y, 0, clearRow);

    for (const auto x : indices(baseRow)) {
      const Rgb base = baseRow[x];
      const float metal = m.metallic * metalRow[x];

      // Only light that is neither reflected by metal nor transmitted is reflected diffusely.
      const float clear = clearRow[x], rest = 1 - metal;
      if (mixesDiffuse) {
        const float blocked = m.variesTransmission() ? 1 - m.transmission * clear : 1;
        const Rgb diffuse = base * ((m.mixesMetal() ? rest : 1) * blocked);
        diffuseMap->texels[i] = encodeTexel(diffuse, diffuseMap->format);
      }

      if (transmissionMap) transmissionMap->texels[i] = encodeColorTexel(base * (clear * rest));

      // F0 is blended between the dielectric's and the base color of the metal.
      if (mixesSpecular) {
        const Rgb f0 = m.bakesSpecular()
                           ? m.f0(tintRow[x], strengthRow[x]) * (1 - metal) + m.base * base * metal
                           : base;
        specularMap->texels[i] = encodeColorTexel(f0);
      }
      ++i;
    }
  }
  return maps;
}

Texture normalTexture(const GltfMaterial& material, const RawImage& raw) {
  if (material.normalsMayBeHeights && looksLikeHeights(raw)) {
    return normalsFromHeights(material.name, raw, material.normalScale, material.normalMap.wrapU,
                              material.normalMap.wrapV);
  }

  Texture texture = makeTexture(material.name, raw, TexelFormat::data);
  if (material.normalScale == 1) return texture;

  // The scale multiplies x and y before the normal is normalized (glTF's normalTextureInfo.scale).
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

Texture alphaRamp(const std::string& name) {
  Texture texture = emptyTexture(name, TexelFormat::data, 2, 1);
  texture.texels = {encodeDataTexel(0, 0, 0, 1), encodeDataTexel(1, 1, 1, 1)};
  texture.wrapU = texture.wrapV = Wrap::clamp;
  return texture;
}

// Stores the share of indirect light, 1 + strength (R - 1). Returns none where the map dims
// nothing.
std::optional<Texture> occlusionTexture(const GltfMaterial& material, const RawImage& raw) {
  Texture texture = makeTexture(material.name, raw, TexelFormat::data);
  bool dims = false;

  for (std::uint32_t& texel : texture.texels) {
    const float share =
        1 + material.occlusionStrength * (static_cast<float>(texel & 255u) / 255 - 1);
    texel = encodeDataTexel(share, 0, 0, 1);
    dims = dims || share < 1;
  }

  return dims ? std::optional(std::move(texture)) : std::nullopt;
}

RawImage inLinearLight(const RawImage& raw, const ImageLimits& limits) {
  RawImage all = startImage("a repeated texture", raw.width, raw.height, 3, true, limits);
  all.values.reserve(3 * raw.pixels());
  for (const auto i : indices(raw.pixels())) {
    const Rgb color = linearPixel(raw, i);
    all.values.insert(all.values.end(), {color.x, color.y, color.z});
  }
  return all;
}

// A row of texels that is shown several times.
struct RepeatedRow {
  std::vector<Between> shown;
  bool isBetween = false;  // it begins between two texels
  bool isCoarse = false;   // and its own ones do not keep their edges
};

// It keeps all texels unless that takes more than an image of usual size.
RepeatedRow repeatedRow(int texels, double times, double begin, bool nearest) {
  constexpr double kFinest = 2048, kSharp = 4;
  const double most = std::max(texels, 4096);
  const double count = std::clamp(std::round(std::abs(times) * texels), 1.0, most);

  const double start = begin * texels;
  const bool isBetween = texels > 1 && std::abs(start - std::round(start)) > kTexelRounding;
  const double finer = isBetween ? std::max(std::floor(kFinest / count), 1.0) : 1;
  return {resample(texels, finer * count, times, begin, Wrap::repeat, nearest), isBetween,
          isBetween && finer < kSharp};
}

RawImage repeated(const RawImage& raw, const RepeatedRow& columns, const RepeatedRow& rows,
                  const ImageLimits& limits) {
  RawImage all = startImage("a repeated texture", std::ssize(columns.shown), std::ssize(rows.shown),
                            raw.channels, raw.linear, limits);

  const auto channels = static_cast<std::size_t>(raw.channels);
  const std::size_t values = all.pixels() * channels;
  all.values.reserve(raw.linear ? values : 0);
  all.codes.reserve(raw.linear ? 0 : values);
  for (const Between& row : rows.shown) {
    for (const Between& column : columns.shown) {
      for (std::size_t c = 0; c < channels; ++c) {
        const float value = blend(raw, column, row, [&](std::size_t i) {
          const std::size_t at = i * channels + c;
          return raw.linear ? raw.values[at] : static_cast<float>(raw.codes[at]);
        });
        if (raw.linear) all.values.push_back(value);
        if (!raw.linear) all.codes.push_back(static_cast<std::uint8_t>(std::lround(value)));
      }
    }
  }
  return all;
}

Texture maskTexture(const GltfMaterial& material, const RawImage& raw, GltfMeans& means) {
  const bool byAlpha = hasTranslucentAlpha(raw);
  means.maskBlends = isMostlyGray(raw, byAlpha ? 3 : 0);
  return byAlpha ? makeAlphaTexture(material.name, raw)
                 : makeTexture(material.name, raw, TexelFormat::data);
}

bool mayBlend(const GltfMaterial& m) {
  return m.alphaMode == GltfMaterial::Alpha::blend || m.maskMayBlend;
}

// The material whose maps are requested, and what they are made from. Tasks that make textures
// later have a copy.
struct MapRequest {
  GltfMaterial material;
  const std::vector<std::shared_ptr<GltfImage>>& images;
  TextureLoader& textures;
  Warnings& warnings;
  std::shared_ptr<GltfMeans> means;

  // Returns null if there is no image, or none that can be read.
  std::shared_ptr<const RawImage> decoded(const GltfTexture& map, const Repeats& repeats) const {
    const ImageLimits limits = textures.limits();
    auto raw = map.image ? images[*map.image]->decode(limits) : nullptr;
    if (!raw || repeats == Repeats()) return raw;

    const auto columns = repeatedRow(raw->width, repeats.u, repeats.u0, map.nearest);
    const auto rows = repeatedRow(raw->height, repeats.v, repeats.v0, map.nearest);
    if (columns.isCoarse || rows.isCoarse) {
      warnings.add("texture blurred: a third transform shifts it by a fraction of a texel",
                   material.where);
    }

    if (repeats.isColor && (columns.isBetween || rows.isBetween)) {
      raw = std::make_shared<const RawImage>(inLinearLight(*raw, limits));
    }
    return std::make_shared<const RawImage>(repeated(*raw, columns, rows, limits));
  }
  // The same, for the coordinates that the material looks the map up with.
  std::shared_ptr<const RawImage> decoded(const GltfTexture& map) const {
    return decoded(map, repeatsOf(material, map).value_or(Repeats()));
  }
};

// The images of base color, metalness, specular reflection and transmission are baked into the maps
// that a Material has.
void requestBaked(const MapRequest& request, Material& slots) {
  const GltfMaterial& m = request.material;
  if (!m.baseMap.exists() && !m.metallicRoughnessMap.exists() && !m.variesF0() &&
      !m.variesTransmission() && !m.multipliesAlpha()) {
    return;
  }

  const auto baked = request.textures.add(kGltfBakedMaps, [request] {
    const GltfMaterial& m = request.material;
    GltfBakeImages images;
    for (const auto i : indices(images)) images[i] = request.decoded(m.*kBakeMaps[i]);

    const bool isReflectance = images[kBase] && !m.unlit;
    if (isReflectance) warnOfClampedColors(m.where, *images[kBase], request.warnings);
    if (const auto& tint = images[kSpecularColor]) {
      warnOfClampedColors(m.where, *tint, request.warnings);
    }
    return bake(m, images, request.textures.limits(), request.warnings, *request.means);
  });

  if (wantsBaked(m, kGltfDiffuse)) {
    auto& slot = m.unlit ? slots.emissionMap : slots.diffuseMap;
    slot = baked[kGltfDiffuse];
  }
  if (wantsBaked(m, kGltfSpecular)) {
    slots.specularMap = baked[kGltfSpecular];
    if (m.mirrorsByMap()) slots.mirrorMap = slots.specularMap;
  }
  if (wantsBaked(m, kGltfTransmission)) slots.transmissionMap = baked[kGltfTransmission];

  if (m.alphaMode != GltfMaterial::Alpha::opaque) slots.alphaMap = baked[kGltfAlpha];
  if (mayBlend(m)) slots.coverageMap = slots.alphaMap;
}

// Where there are no maps, meshes keep the alpha of their vertices as the coordinate u, which a
// ramp turns into opacity.
void requestVertexAlpha(const MapRequest& request, Material& slots) {
  const GltfMaterial& m = request.material;
  if (!m.alphaByVertex || m.isMapped()) return;

  slots.alphaMap = request.textures.add(1, [name = m.name] { return Images{alphaRamp(name)}; })[0];
  if (m.alphaMode == GltfMaterial::Alpha::blend) slots.coverageMap = slots.alphaMap;
  request.means->alphaByMap = true;
}

// Requests the maps that are made from one image each.
void requestSingleMaps(const MapRequest& request, Material& slots) {
  const GltfMaterial& m = request.material;

  // Returns a slot for the texture that `make` computes from an image, which may be none.
  const auto single = [&](const GltfTexture& map, const auto& make) {
    const Repeats repeats = repeatsOf(m, map).value_or(Repeats());
    return request.textures.add(1, [request, map, repeats, make] {
      Images made(1);
      const auto raw = request.decoded(map, repeats);
      if (!raw) return made;

      const GltfMaterial& m = request.material;
      const MemoryHold held = holdImage(m.where, raw->width, raw->height, sizeof(std::uint32_t),
                                        request.textures.limits());
      made[0] = make(m, *raw);
      if (made[0]) setSampler(map, *made[0]);
      return made;
    })[0];
  };

  if (m.normalMap.exists()) slots.normalMap = single(m.normalMap, normalTexture);
  if (m.occlusionMap.exists()) slots.occlusionMap = single(m.occlusionMap, occlusionTexture);
  if (m.maskMap.exists()) {
    slots.alphaMap = slots.coverageMap =
        single(m.maskMap, [means = request.means](const auto& m, const auto& raw) {
          return std::optional(maskTexture(m, raw, *means));
        });
  }

  if (m.variesRoughness()) {
    slots.roughnessMap =
        single(m.roughnessMap, [means = request.means](const auto& m, const auto& raw) {
          // Where the map has the same value everywhere, its mean replaces it.
          const ChannelMean roughness = meanOf(raw, 1);
          means->roughness = roughness.mean;
          means->roughnessByMap = roughness.varies;
          return means->roughnessByMap ? std::optional(makeTexture(m.name, raw, TexelFormat::data))
                                       : std::nullopt;
        });
  }

  if (m.emitsByMap()) {
    slots.emissionMap =
        single(m.emissiveMap, [&warnings = request.warnings](const auto& m, const auto& raw) {
          return makeEmissionTexture(m.name, raw, warnings);
        });
  }
}

// The mean of a channel is multiplied into a factor that has no map in a Material.
void requestMean(const MapRequest& request, const GltfTexture& map, std::size_t channel,
                 float GltfMeans::*to, const char* warning) {
  if (!map.exists()) return;
  request.textures.add(0, [=] {
    if (const auto raw = request.decoded(map, Repeats())) {
      const ChannelMean found = meanOf(*raw, channel);
      (*request.means).*to = found.mean;
      if (found.varies) request.warnings.add(warning, request.material.where);
    }
    return Images();
  });
}

// Lists everything on which the maps and their means depend. Materials with equal keys share them.
std::string keyOf(const GltfMaterial& m) {
  std::ostringstream key;
  for (const GltfTexture* map :
       {&m.baseMap, &m.metallicRoughnessMap, &m.normalMap, &m.emissiveMap, &m.specularMap,
        &m.specularColorMap, &m.transmissionMap, &m.clearcoatMap, &m.clearcoatRoughnessMap,
        &m.roughnessMap, &m.maskMap, &m.occlusionMap}) {
    key << (map->image ? static_cast<std::int64_t>(*map->image) : -1) << ' '
        << static_cast<int>(map->wrapU) << static_cast<int>(map->wrapV) << map->nearest << ' ';
    // Nothing is shared of what is resampled for one material.
    if (repeatsOf(m, *map) != Repeats()) key << m.where << ' ';
  }

  key << std::hexfloat << m.normalScale << ' ' << m.occlusionStrength << ' '
      << static_cast<int>(m.alphaMode) << ' ' << m.alphaByVertex << m.mirrorsByMap() << ' '
      << m.transmission << ' ' << (m.clearcoat > 0) << m.emitsByMap() << m.unlit << ' '
      << m.metallic << ' ' << m.variesRoughness() << ' ';

  // These factors are baked into the specular texture.
  if (m.bakesSpecular()) {
    key << m.f90 << ' ';
    for (int i = 0; i < 3; ++i) key << m.specularColor[i] << ' ' << m.base[i] << ' ';
  }

  return key.str();
}

// Replaces what a scene file has not `given` by what `fresh` has. Maps stay.
void renew(Material& to, const Material& fresh, const GivenMembers& given) {
  const float cutoff = to.alphaCutoff;

  forEachMember<Material>([&](const auto& member) {
    if (member.rules.kind == MemberKind::map || given.contains(member.name)) return;
    to.*member.field = fresh.*member.field;
  });

  // The cutoff belongs to the alpha map, which the scene file gives.
  if (given.contains("alphaMap")) to.alphaCutoff = cutoff;
}

}  // namespace

GltfMapMaker::GltfMapMaker(const std::vector<GltfImageSource>& images, Warnings& warnings)
    : warnings_(warnings) {
  for (const GltfImageSource& source : images) {
    images_.push_back(std::make_shared<GltfImage>(source, warnings));
  }
}

TexturedMaterial GltfMapMaker::withMaps(const GltfMaterial& source, Material material,
                                        const GivenMembers& given, TextureLoader& textures,
                                        GltfShading shading) {
  if (lacksCoordinates(source)) {
    warnings_.add(
        "texture looked up with the coordinates of its material's first in place of its own",
        source.where);
  }

  const GltfMaps maps = request(source, textures);
  forEachMap([&](const auto& member) {
    const bool isReplaced = std::ranges::any_of(kReplacedMaps, [&](const ReplacedMap& replaced) {
      return replaced.map == member.field && given.contains(replaced.member);
    });
    if (isReplaced || given.contains(member.name)) return;
    material.*member.field = maps.slots.*member.field;
  });

  // Factors follow from the means, which are known when the images have been decoded.
  const bool maskMayBlend = source.maskMayBlend;
  const auto renewed = [shading = std::move(shading), given, means = maps.means,
                        maskMayBlend](Material& m) {
    renew(m, shading(*means), given);
    const bool isCutOnly = maskMayBlend && !means->maskBlends;
    if (isCutOnly && !given.contains("coverageMap")) m.coverageMap = kNoTexture;
  };

  return {std::move(material), renewed};
}

GltfMaps GltfMapMaker::request(const GltfMaterial& m, TextureLoader& textures) {
  const auto [entry, isNew] = known_.try_emplace(keyOf(m));
  GltfMaps& maps = entry->second;
  if (!isNew) return maps;

  const MapRequest request{m, images_, textures, warnings_, std::make_shared<GltfMeans>()};
  maps.means = request.means;
  requestBaked(request, maps.slots);
  requestVertexAlpha(request, maps.slots);
  requestSingleMaps(request, maps.slots);

  if (m.clearcoat > 0) {
    requestMean(request, m.clearcoatMap, 0, &GltfMeans::clearcoat,
                "clearcoat by a texture taken by its mean");
    requestMean(request, m.clearcoatRoughnessMap, 1, &GltfMeans::clearcoatRoughness,
                "roughness of a clearcoat by a texture taken by its mean");
  }

  return maps;
}

}  // namespace whit
