#include "bake/mip_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/worker_pool.h"

namespace whit {

namespace {

// The texels along one axis that a texel of the next level covers, and their shares of it.
struct Cover {
  std::array<int, 3> texel{};
  std::array<double, 3> share{};
  std::size_t count = 0;
};

std::vector<Cover> coversOf(int size, int half) {
  std::vector<Cover> covers(static_cast<std::size_t>(half));
  // In units of 1 / half of a texel all borders are whole numbers.
  for (int i = 0; i < half; ++i) {
    Cover& cover = covers[static_cast<std::size_t>(i)];
    const std::int64_t begin = std::int64_t{i} * size, end = begin + size;
    for (std::int64_t texel = begin / half; texel * half < end; ++texel) {
      const std::int64_t covered =
          std::min(end, (texel + 1) * half) - std::max(begin, texel * half);
      cover.texel[cover.count] = static_cast<int>(texel);
      cover.share[cover.count++] = static_cast<double>(covered) / size;
    }
  }
  return covers;
}

// Light of a 10-bit color channel, or the value of an 8-bit one, in units of the largest code
// (squared); of radiance itself.
double valueOf(TexelFormat format, std::uint32_t texel, int channel) {
  if (format == TexelFormat::data) return texel >> (8 * channel) & 255u;
  if (format == TexelFormat::radiance) {
    return static_cast<double>(decodeRadianceTexel(texel)[channel]);
  }
  const double root = texel >> (10 * channel) & 1023u;
  return root * root;
}

std::uint32_t codeOf(TexelFormat format, double value, int channel) {
  // Halves go to the even code, so that one level after the other does not get lighter.
  const double code = std::nearbyint(format == TexelFormat::data ? value : std::sqrt(value));
  return static_cast<std::uint32_t>(code) << (format == TexelFormat::data ? 8 : 10) * channel;
}

std::uint32_t meanTexel(const Texture& texture, const Cover& columns, const Cover& rows) {
  std::array<double, 4> sum{};
  const int channels = texture.format == TexelFormat::data ? 4 : 3;
  for (std::size_t row = 0; row < rows.count; ++row) {
    for (std::size_t column = 0; column < columns.count; ++column) {
      const std::uint32_t texel = texture.texel(columns.texel[column], rows.texel[row]);
      const double share = rows.share[row] * columns.share[column];
      for (int c = 0; c < channels; ++c) {
        sum[static_cast<std::size_t>(c)] += share * valueOf(texture.format, texel, c);
      }
    }
  }
  if (texture.format == TexelFormat::radiance) {
    return encodeRadianceTexel(Rgb(RgbD(sum[0], sum[1], sum[2])));
  }
  std::uint32_t mean = 0;
  for (int c = 0; c < channels; ++c) {
    mean |= codeOf(texture.format, sum[static_cast<std::size_t>(c)], c);
  }
  return mean;
}

std::vector<bool> seenTextures(const Scene& scene) {
  std::vector<bool> seen(scene.textures.size(), false);
  for (const Material& m : scene.materials) {
    for (const std::int32_t map :
         {m.diffuseMap, m.specularMap, m.roughnessMap, m.emissionMap, m.normalMap, m.coverageMap}) {
      if (map != kNoTexture) seen[static_cast<std::size_t>(map)] = true;
    }
  }
  return seen;
}

}  // namespace

Texture halved(const Texture& texture) {
  Texture half = emptyTexture(texture.name, texture.format, std::max(1, texture.width / 2),
                              std::max(1, texture.height / 2));
  half.wrapU = texture.wrapU;
  half.wrapV = texture.wrapV;
  std::uint32_t* to = half.texels.data();
  const std::vector<Cover> columns = coversOf(texture.width, half.width);
  const std::vector<Cover> rows = coversOf(texture.height, half.height);
  for (const Cover& row : rows) {
    for (const Cover& column : columns) *to++ = meanTexel(texture, column, row);
  }
  return half;
}

MipMaps::MipMaps(const std::vector<Texture>& textures, const std::vector<bool>& wanted, int threads)
    : textures_(&textures), smaller_(textures.size()) {
  std::vector<std::size_t> made;
  for (std::size_t i = 0; i < textures.size(); ++i) {
    if (wanted[i]) made.push_back(i);
  }
  parallelFor(threads, made.size(), [&](std::size_t k, int) {
    const Texture* last = &textures[made[k]];
    std::vector<Texture>& levels = smaller_[made[k]];
    levels.reserve(kMipLevels);
    while (last->width > 1 || last->height > 1) {
      levels.push_back(halved(*last));
      last = &levels.back();
    }
  });
}

MipMaps::MipMaps(const Scene& scene, int threads)
    : MipMaps(scene.textures, seenTextures(scene), threads) {}

const Texture& MipMaps::level(std::size_t texture, int level) const {
  const std::vector<Texture>& smaller = smaller_[texture];
  if (level == 0 || smaller.empty()) return (*textures_)[texture];
  return smaller[std::min(static_cast<std::size_t>(level), smaller.size()) - 1];
}

Texture MipMaps::take(std::size_t texture, int level) {
  if (level == 0) return (*textures_)[texture];
  return std::move(smaller_[texture][static_cast<std::size_t>(level) - 1]);
}

int MipMaps::levels(std::size_t texture) const {
  return static_cast<int>(smaller_[texture].size()) + 1;
}

}  // namespace whit
