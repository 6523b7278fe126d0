#include "oracle/mip_chain.h"

#include <utility>

#include "oracle/bilinear.h"

namespace oracle {

namespace {

// A part of a row or column of texels.
struct Stretch {
  double from = 0, to = 0;

  double coveredOf(int texel) const {
    return std::max(0.0, std::min(to, texel + 1.0) - std::max(from, double(texel)));
  }
};

Stretch stretchOf(int i, int size, int half) {
  const double each = double(size) / half;
  return {i * each, (i + 1) * each};
}

// whit keeps colors as the square root of light in 10 bits, data in 8.
Color asCodes(const Color& mean, bool isData) {
  // Without the rounding errors of the mean, because exact halves go to the even code.
  const auto rounded = [](double code) { return std::nearbyint(std::round(code * 1e6) / 1e6); };
  const auto channel = [&](double value) {
    if (isData) return rounded(value * 255) / 255;
    const double code = rounded(std::sqrt(value) * 1023) / 1023;
    return code * code;
  };
  return {channel(mean.x), channel(mean.y), channel(mean.z)};
}

}  // namespace

Shares uncutShares(const Texture& alpha, double cutoff) {
  Shares shares{alpha.width, alpha.height, {}};
  const auto texel = [&](int x, int y) {
    const int place = wrapped(y, alpha.height) * alpha.width + wrapped(x, alpha.width);
    return gray(alpha.texels[static_cast<std::size_t>(place)][0] / 255.0);
  };

  for (int y = 0; y < alpha.height; ++y) {
    for (int x = 0; x < alpha.width; ++x) {
      double left = 0;
      for (const double right : {0.25, 0.75}) {
        for (const double down : {0.25, 0.75}) {
          if (bilinear(x + right, y + down, texel).x >= cutoff) left += 0.25;
        }
      }
      shares.of.push_back(left);
    }
  }

  return shares;
}

Shares coveredShares(const Texture& coverage) {
  Shares shares{coverage.width, coverage.height, {}};
  for (const auto& texel : coverage.texels) shares.of.push_back(texel[0] / 255.0);
  return shares;
}

Shares stretched(const Shares& shares, int width, int height) {
  Shares result{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Stretch columns = stretchOf(x, shares.width, width),
                    rows = stretchOf(y, shares.height, height);
      double sum = 0, area = 0;
      for (int row = 0; row < shares.height; ++row) {
        for (int column = 0; column < shares.width; ++column) {
          const double covered = columns.coveredOf(column) * rows.coveredOf(row);
          sum += shares.of[static_cast<std::size_t>(row * shares.width + column)] * covered;
          area += covered;
        }
      }
      result.of.push_back(sum / area);
    }
  }

  return result;
}

MipChain::MipChain(const Texture& texture, Shares left) {
  Level whole{texture.width, texture.height, {}};
  for (const auto& [r, g, b] : texture.texels) {
    whole.texels.push_back(Color{double(r), double(g), double(b)} / 255);
  }
  levels_.push_back(whole);

  // The shares of each level; none where nothing is cut away.
  const bool isCut = !left.of.empty();
  std::vector<Shares> leftOf;
  leftOf.push_back(std::move(left));
  while (levels_.back().texels.size() > 1) {
    const std::size_t last = isCut ? levels_.size() - 1 : 0;
    levels_.push_back(halved(levels_.back(), leftOf[last], texture.isData));
    const Level& half = levels_.back();
    if (isCut) leftOf.push_back(stretched(leftOf[last], half.width, half.height));
  }

  // What is cut away takes the color of the level above.
  for (std::size_t n = levels_.size() - 1; isCut && n-- > 1;) {
    Level& level = levels_[n];
    const Level& above = levels_[n + 1];
    for (int y = 0; y < level.height; ++y) {
      for (int x = 0; x < level.width; ++x) {
        const auto place = static_cast<std::size_t>(y * level.width + x);
        if (leftOf[n].of[place] > 0) continue;
        level.texels[place] =
            above.texel(std::min(x / 2, above.width - 1), std::min(y / 2, above.height - 1));
      }
    }
  }
}

// The mean of what a texel covers, also where that cuts through others.
MipChain::Level MipChain::halved(const Level& level, const Shares& left, bool isData) {
  Level half{std::max(1, level.width / 2), std::max(1, level.height / 2), {}};
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      const Stretch columns = stretchOf(x, level.width, half.width),
                    rows = stretchOf(y, level.height, half.height);

      Color sum;
      double area = 0;
      for (int row = 0; row < level.height; ++row) {
        for (int column = 0; column < level.width; ++column) {
          double covered = columns.coveredOf(column) * rows.coveredOf(row);
          if (!left.of.empty()) {
            covered *= left.of[static_cast<std::size_t>(row * level.width + column)];
          }
          sum += level.texel(column, row) * covered;
          area += covered;
        }
      }
      half.texels.push_back(asCodes(area > 0 ? sum / area : Color{}, isData));
    }
  }
  return half;
}

Color MipChain::Level::texel(int x, int y) const {
  return texels[static_cast<std::size_t>(wrapped(y, height) * width + wrapped(x, width))];
}

Color MipChain::Level::mixed(double u, double v) const {
  return bilinear(u * width, (1 - v) * height, [&](int x, int y) { return texel(x, y); });
}

const MipChain::Level& MipChain::level(int number) const {
  return levels_[std::min(static_cast<std::size_t>(number), levels_.size() - 1)];
}

Color MipChain::at(double u, double v, Filter filter, double texels) const {
  const Level& whole = levels_[0];
  if (filter == Filter::bilinear) return whole.mixed(u, v);
  if (filter == Filter::nearest) {
    return whole.texel(static_cast<int>(std::floor(u * whole.width)),
                       static_cast<int>(std::floor((1 - v) * whole.height)));
  }

  // Each level's texels are four times as large as those before.
  const double number = std::max(0.0, std::log(texels) / std::log(4));
  const int below = static_cast<int>(number);
  return mix(level(below).mixed(u, v), level(below + 1).mixed(u, v), number - below);
}

}  // namespace oracle
