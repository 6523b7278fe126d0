#include "oracle/mip_chain.h"

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
  const auto channel = [&](double value) {
    // The mean of four codes is a number of quarters: exactly, since halves go to the even code.
    if (isData) return std::nearbyint(std::round(value * 255 * 4) / 4) / 255;
    const double code = std::nearbyint(std::sqrt(value) * 1023) / 1023;
    return code * code;
  };
  return {channel(mean.x), channel(mean.y), channel(mean.z)};
}

}  // namespace

MipChain::MipChain(const Texture& texture) {
  Level whole{texture.width, texture.height, {}};
  for (const auto& [r, g, b] : texture.texels) {
    whole.texels.push_back(Color{double(r), double(g), double(b)} / 255);
  }
  levels_.push_back(whole);
  while (levels_.back().texels.size() > 1)
    levels_.push_back(halved(levels_.back(), texture.isData));
}

// The mean of what a texel covers, also where that cuts through others.
MipChain::Level MipChain::halved(const Level& level, bool isData) {
  Level half{std::max(1, level.width / 2), std::max(1, level.height / 2), {}};
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      const Stretch columns = stretchOf(x, level.width, half.width),
                    rows = stretchOf(y, level.height, half.height);
      Color sum;
      double area = 0;
      for (int row = 0; row < level.height; ++row) {
        for (int column = 0; column < level.width; ++column) {
          const double covered = columns.coveredOf(column) * rows.coveredOf(row);
          sum += level.texel(column, row) * covered;
          area += covered;
        }
      }
      half.texels.push_back(asCodes(sum / area, isData));
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
