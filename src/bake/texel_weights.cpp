#include "bake/texel_weights.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/index.h"

namespace whit {

namespace {

float firstChannelAt(const Texture& mask, int column, int row) {
  return static_cast<float>(mask.texel(column, row) & 255u) / 255.0f;
}

TexelWeights weightsLike(const Texture& mask) {
  TexelWeights weights{mask.width, mask.height, {}};
  weights.values.reserve(cellsOf(mask.width, mask.height));
  return weights;
}

}  // namespace

std::vector<TexelCover> texelCovers(int size, int count) {
  std::vector<TexelCover> covers(count);
  // All borders are whole numbers in units of 1 / count of a texel.
  std::int64_t begin = 0;
  for (TexelCover& cover : covers) {
    const std::int64_t end = begin + size;
    cover.first = static_cast<int>(begin / count);
    for (std::int64_t texel = cover.first; texel * count < end; ++texel) {
      const std::int64_t covered =
          std::min(end, (texel + 1) * count) - std::max(begin, texel * count);
      cover.shares.push_back(static_cast<double>(covered) / size);
    }
    begin = end;
  }
  return covers;
}

TexelWeights uncutShares(const Texture& mask, float cutoff) {
  TexelWeights shares = weightsLike(mask);

  // At the midpoint of a quarter, the neighbor on that side counts for a quarter in each direction.
  const auto between = [](float own, float other) { return 0.75f * own + 0.25f * other; };

  // The columns with one more on each side, as the mask is continued there.
  std::vector<int> columns;
  for (int column = -1; column <= mask.width; ++column) {
    columns.push_back(wrapTexel(column, mask.width, mask.wrapU));
  }

  // A row halfway to the one above it, and halfway to the one below.
  std::array<std::vector<float>, 2> halfway;
  for (std::vector<float>& values : halfway) values.resize(columns.size());

  for (int row = 0; row < mask.height; ++row) {
    const int others[] = {wrapTexel(row - 1, mask.height, mask.wrapV),
                          wrapTexel(row + 1, mask.height, mask.wrapV)};
    for (const auto side : indices(halfway)) {
      for (const auto i : indices(columns)) {
        halfway[side][i] = between(firstChannelAt(mask, columns[i], row),
                                   firstChannelAt(mask, columns[i], others[side]));
      }
    }

    // The mask is compared at the midpoints of the texel's four quarters.
    for (std::size_t i = 1; i + 1 < columns.size(); ++i) {
      int uncut = 0;
      for (const std::vector<float>& values : halfway) {
        uncut += between(values[i], values[i - 1]) >= cutoff;
        uncut += between(values[i], values[i + 1]) >= cutoff;
      }
      shares.values.push_back(uncut / 4.0);
    }
  }
  return shares;
}

TexelWeights firstChannel(const Texture& mask) {
  TexelWeights weights = weightsLike(mask);
  for (int row = 0; row < mask.height; ++row) {
    for (int column = 0; column < mask.width; ++column) {
      weights.values.push_back((mask.texel(column, row) & 255u) / 255.0);
    }
  }
  return weights;
}

TexelWeights resized(const TexelWeights& weights, int width, int height) {
  if (weights.width == width && weights.height == height) return weights;

  const std::vector<TexelCover> columns = texelCovers(weights.width, width);
  TexelWeights result{width, height, {}};

  for (const TexelCover& rows : texelCovers(weights.height, height)) {
    for (const TexelCover& across : columns) {
      double sum = 0;
      for (const auto y : indices(rows.shares)) {
        for (const auto x : indices(across.shares)) {
          sum += rows.shares[y] * across.shares[x] *
                 weights.at(across.first + static_cast<int>(x), rows.first + static_cast<int>(y));
        }
      }
      result.values.push_back(sum);
    }
  }
  return result;
}

}  // namespace whit
