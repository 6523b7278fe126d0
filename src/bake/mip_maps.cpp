#include "bake/mip_maps.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <tuple>
#include <utility>

#include "bake/texel_weights.h"
#include "core/index.h"
#include "core/worker_pool.h"

namespace whit {

namespace {

// Alpha maps have none; see ShownMap.
constexpr std::int32_t Material::*kMippedMaps[] = {
    &Material::diffuseMap,   &Material::specularMap, &Material::roughnessMap,
    &Material::emissionMap,  &Material::normalMap,   &Material::coverageMap,
    &Material::occlusionMap, &Material::mirrorMap,   &Material::transmissionMap};

// Values of the channels of a texel, in units of the largest code: of a color (10 bits) the linear
// light, in the square of these units; of data (8 bits) the codes. Radiance is returned itself.
std::array<double, 4> valuesOf(TexelFormat format, std::uint32_t texel) {
  if (format == TexelFormat::radiance) {
    const Rgb radiance = decodeRadianceTexel(texel);
    return {radiance.x, radiance.y, radiance.z, 0};
  }
  if (format == TexelFormat::data) {
    return {double(texel & 255u), double(texel >> 8 & 255u), double(texel >> 16 & 255u),
            double(texel >> 24)};
  }

  const double r = texel & 1023u, g = texel >> 10 & 1023u, b = texel >> 20 & 1023u;
  return {r * r, g * g, b * b, 0};
}

// The code nearest to a mean. Halves go to the even code, so that one level after the other does
// not get lighter. Means are often halves but for rounding errors, which must not decide.
std::uint32_t codeOf(TexelFormat format, double value, std::size_t channel) {
  constexpr double kBeyondErrors = 1 << 20;
  const double code = format == TexelFormat::data ? value : std::sqrt(value);
  // Adding and subtracting 2^52 is std::nearbyint(), without a call.
  const auto rounded = [](double x) { return (x + 0x1p52) - 0x1p52; };
  const double nearest = rounded(rounded(code * kBeyondErrors) / kBeyondErrors);
  return static_cast<std::uint32_t>(nearest) << (format == TexelFormat::data ? 8 : 10) * channel;
}

// Sum over the covered texels, weighted by their shares, or mean by shares times `weights` if there
// are any. The result is black where all weights are 0.
std::uint32_t meanTexel(const Texture& texture, const TexelWeights* weights,
                        const TexelCover& columns, const TexelCover& rows) {
  std::array<double, 4> sum{};
  double total = 0;

  for (const auto y : indices(rows.shares)) {
    for (const auto x : indices(columns.shares)) {
      const int column = columns.first + static_cast<int>(x);
      const int row = rows.first + static_cast<int>(y);
      double share = rows.shares[y] * columns.shares[x];
      if (weights) share *= weights->at(column, row);
      total += share;

      const std::array<double, 4> values = valuesOf(texture.format, texture.texel(column, row));
      for (const auto c : indices(values)) sum[c] += share * values[c];
    }
  }
  if (weights && total > 0) {
    for (double& channel : sum) channel /= total;
  }

  if (texture.format == TexelFormat::radiance) {
    return encodeRadianceTexel(Rgb(RgbD(sum[0], sum[1], sum[2])));
  }
  const std::size_t channels = texture.format == TexelFormat::data ? 4 : 3;
  std::uint32_t mean = 0;
  for (const auto c : indices(channels)) mean |= codeOf(texture.format, sum[c], c);
  return mean;
}

// The codes that meanTexel() finds for four texels of equal weights, from whole numbers.
std::uint32_t meanOfFour(TexelFormat format, const std::array<std::uint32_t, 4>& texels) {
  const bool isData = format == TexelFormat::data;
  const int bits = isData ? 8 : 10;
  const std::uint32_t most = (1u << bits) - 1;

  std::uint32_t mean = 0;
  for (int shift = 0; shift + bits <= 32; shift += bits) {
    std::uint32_t sum = 0;
    for (const std::uint32_t texel : texels) {
      const std::uint32_t code = texel >> shift & most;
      sum += isData ? code : code * code;
    }

    // Adding 2^23 rounds to a whole number in the low bits. Floats suffice: no sum of squares has a
    // root so close to an odd number without being one.
    const float exact = static_cast<float>(sum);
    const float code = (isData ? exact * 0.25f : std::sqrt(exact) * 0.5f) + 0x1p23f;
    mean |= (std::bit_cast<std::uint32_t>(code) & most) << shift;
  }
  return mean;
}

// The threads share the rows of the result.
Texture halvedBy(const Texture& texture, const TexelWeights* weights, int threads) {
  Texture half = emptyTexture(texture.name, texture.format, std::max(1, texture.width / 2),
                              std::max(1, texture.height / 2));
  half.wrapU = texture.wrapU;
  half.wrapV = texture.wrapV;

  const bool isEven = texture.width % 2 == 0 && texture.height % 2 == 0;
  const std::vector<TexelCover> columns = texelCovers(texture.width, half.width);
  const std::vector<TexelCover> rows = texelCovers(texture.height, half.height);

  const auto fillRow = [&](std::size_t row) {
    std::uint32_t* to = &half.texels[row * columns.size()];
    if (!isEven || texture.format == TexelFormat::radiance) {
      for (const TexelCover& column : columns)
        *to++ = meanTexel(texture, weights, column, rows[row]);
      return;
    }

    const std::uint32_t* const upper = &texture.rows()[2 * row * texture.width];
    const std::uint32_t* const lower = upper + texture.width;
    for (int column = 0; column < texture.width; column += 2) {
      if (weights && !weights->areEqual(column, static_cast<int>(2 * row))) {
        *to++ = meanTexel(texture, weights, entryOf(columns, column / 2), rows[row]);
        continue;
      }
      *to++ = meanOfFour(texture.format,
                         {upper[column], upper[column + 1], lower[column], lower[column + 1]});
    }
  };

  constexpr std::size_t kRows = 64;  // rows of a task
  parallelFor(rows.size() > kRows ? threads : 1, (rows.size() + kRows - 1) / kRows,
              [&](std::size_t task, int) {
                const std::size_t end = std::min((task + 1) * kRows, rows.size());
                for (std::size_t row = task * kRows; row < end; ++row) fillRow(row);
              });
  return half;
}

// The weights of the map's texels at its full size and at each smaller one; empty where no mask
// weights them.
std::vector<TexelWeights> weightsOf(const std::vector<Texture>& textures, const ShownMap& map) {
  const auto texture = [&](std::int32_t number) -> const Texture& { return textures[number]; };
  const Texture& own = texture(map.texture);
  std::vector<TexelWeights> levels;
  // An alpha map cuts rays away: a texel counts by the share of its area that is left.
  if (map.alphaMap != kNoTexture) {
    const TexelWeights uncut = uncutShares(texture(map.alphaMap), map.alphaCutoff);
    levels.push_back(resized(uncut, own.width, own.height));
  }

  if (map.coverageMap != kNoTexture) {
    TexelWeights coverage = resized(firstChannel(texture(map.coverageMap)), own.width, own.height);
    for (std::size_t i = 0; !levels.empty() && i < coverage.values.size(); ++i) {
      coverage.values[i] *= levels[0].values[i];
    }
    levels = {std::move(coverage)};
  }

  while (!levels.empty() && (levels.back().width > 1 || levels.back().height > 1)) {
    const TexelWeights& last = levels.back();
    levels.push_back(resized(last, std::max(1, last.width / 2), std::max(1, last.height / 2)));
  }
  return levels;
}

// Gives texels that nobody sees the color of the level above, because bilinear lookups mix them
// with their neighbors.
void fillUnseen(const TexelWeights& weights, const Texture& above, Texture& level) {
  std::size_t i = 0;
  for (int row = 0; row < level.height; ++row) {
    const int rowAbove = std::min(row / 2, above.height - 1);
    for (int column = 0; column < level.width; ++column, ++i) {
      if (weights.values[i] > 0) continue;
      level.texels[i] = above.texel(std::min(column / 2, above.width - 1), rowAbove);
    }
  }
}

// `weights` are those of weightsOf().
std::vector<Texture> smallerLevels(const Texture& full, const std::vector<TexelWeights>& weights,
                                   int threads) {
  const Texture* last = &full;
  std::vector<Texture> levels;
  levels.reserve(kMipLevels);
  while (last->width > 1 || last->height > 1) {
    levels.push_back(halvedBy(*last, weights.empty() ? nullptr : &weights[levels.size()], threads));
    last = &levels.back();
  }

  // Filling starts at the smallest level, so that colors reach every unseen texel of the larger
  // ones.
  for (std::size_t i = levels.size(); !weights.empty() && i-- > 1;) {
    fillUnseen(weights[i], levels[i], levels[i - 1]);
  }
  return levels;
}

std::vector<ShownMap> shownMaps(const Scene& scene) {
  std::vector<ShownMap> shown;
  for (const Material& m : scene.materials) {
    for (const auto map : kMippedMaps) shown.push_back(shownMap(m, map));
  }
  return shown;
}

}  // namespace

ShownMap shownMap(const Material& material, std::int32_t Material::*map) {
  ShownMap shown{material.*map};
  const bool bySecondUvs = (map == &Material::emissionMap && material.emissionBySecondUvs) ||
                           (map == &Material::normalMap && material.normalBySecondUvs) ||
                           (map == &Material::occlusionMap && material.occlusionBySecondUvs);

  // Masks use the first texture coordinates, so they say nothing about texels of the second.
  if (shown.texture == kNoTexture || bySecondUvs) return shown;

  if (material.alphaMap != kNoTexture) {
    shown.alphaMap = material.alphaMap;
    shown.alphaCutoff = material.alphaCutoff;
  }
  if (map != &Material::coverageMap) shown.coverageMap = material.coverageMap;
  return shown;
}

Texture halved(const Texture& texture) { return halvedBy(texture, nullptr, 1); }

MipMaps::MipMaps(const std::vector<Texture>& textures, const std::vector<ShownMap>& wanted,
                 int threads)
    : textures_(&textures) {
  for (const ShownMap& map : wanted) {
    if (map.texture != kNoTexture) smaller_.try_emplace(map);
  }

  // Maps of one size that the same masks weight are made by one task, with the same weights. These
  // tasks take longest and come first.
  using Entry = std::pair<const ShownMap, std::vector<Texture>>;
  std::map<std::tuple<ShownMap, int, int>, std::vector<Entry*>> groups;
  for (Entry& entry : smaller_) {
    ShownMap masks = entry.first;
    const Texture& full = textures[masks.texture];
    if (masks.alphaMap != kNoTexture || masks.coverageMap != kNoTexture) masks.texture = kNoTexture;
    groups[{masks, full.width, full.height}].push_back(&entry);
  }

  std::vector<const std::vector<Entry*>*> tasks;
  tasks.reserve(groups.size());
  for (const auto& [masks, entries] : groups) tasks.push_back(&entries);

  // Threads beyond the number of tasks help with their levels.
  const int each = std::max(1, threads / std::max(1, static_cast<int>(tasks.size())));
  parallelFor(threads, tasks.size(), [&](std::size_t i, int) {
    const std::vector<TexelWeights> weights = weightsOf(textures, tasks[i]->front()->first);
    for (Entry* const entry : *tasks[i]) {
      entry->second = smallerLevels(textures[entry->first.texture], weights, each);
    }
  });
}

MipMaps::MipMaps(const Scene& scene, int threads)
    : MipMaps(scene.textures, shownMaps(scene), threads) {}

const Texture& MipMaps::level(const ShownMap& map, int level) const {
  const Texture& full = (*textures_)[map.texture];
  if (level == 0) return full;

  const auto smaller = smaller_.find(map);
  if (smaller == smaller_.end() || smaller->second.empty()) return full;
  return smaller->second[std::min(static_cast<std::size_t>(level), smaller->second.size()) - 1];
}

Texture MipMaps::take(const ShownMap& map, int level) {
  return std::move(smaller_.at(map)[static_cast<std::size_t>(level) - 1]);
}

int MipMaps::levels(const ShownMap& map) const {
  const auto smaller = smaller_.find(map);
  return smaller == smaller_.end() ? 1 : static_cast<int>(smaller->second.size()) + 1;
}

}  // namespace whit
