#include "oracle/mip_chain.h"

#include <utility>

#include "oracle/bilinear.h"

namespace oracle {

namespace {

// How much of the texel lies between the ends of a stretch of its row or column.
double coveredOf(int texel, double from, double to) {
  return std::max(0.0, std::min(to, texel + 1.0) - std::max(from, double(texel)));
}

// Calls visit(index, area) for each texel of a picture of which a texel (x, y) of a smaller picture
// covers an area, with the texel's index.
template <typename Visit>
void forEachCovered(int width, int height, int x, int y, int smallWidth, int smallHeight,
                    const Visit& visit) {
  const double each = double(width) / smallWidth, down = double(height) / smallHeight;
  forEachPixel(width, height, [&](int column, int row) {
    visit(row * width + column,
          coveredOf(column, x * each, (x + 1) * each) * coveredOf(row, y * down, (y + 1) * down));
  });
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
  return eachOf(channel, mean);
}

}  // namespace

Shares uncutShares(const Texture& alpha, double cutoff) {
  Shares shares{alpha.width, alpha.height, {}};
  const auto texel = [&](int x, int y) {
    const int place = wrapped(y, alpha.height) * alpha.width + wrapped(x, alpha.width);
    return gray(alpha.texels[place][0] / 255.0);
  };

  forEachPixel(alpha.width, alpha.height, [&](int x, int y) {
    double left = 0;
    for (const double right : {0.25, 0.75}) {
      for (const double down : {0.25, 0.75}) {
        if (bilinear(x + right, y + down, texel).x >= cutoff) left += 0.25;
      }
    }
    shares.of.push_back(left);
  });

  return shares;
}

Shares coveredShares(const Texture& coverage) {
  Shares shares{coverage.width, coverage.height, {}};
  for (const auto& texel : coverage.texels) shares.of.push_back(texel[0] / 255.0);
  return shares;
}

Shares stretched(const Shares& shares, int width, int height) {
  Shares result{width, height, {}};
  forEachPixel(width, height, [&](int x, int y) {
    double sum = 0, area = 0;
    forEachCovered(shares.width, shares.height, x, y, width, height, [&](int texel, double part) {
      sum += shares.of[texel] * part;
      area += part;
    });
    result.of.push_back(sum / area);
  });
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
    forEachPixel(level.width, level.height, [&](int x, int y) {
      const int place = y * level.width + x;
      if (leftOf[n].of[place] > 0) return;
      level.texels[place] =
          above.texel(std::min(x / 2, above.width - 1), std::min(y / 2, above.height - 1));
    });
  }
}

// The mean of what a texel covers, also where that cuts through others.
MipChain::Level MipChain::halved(const Level& level, const Shares& left, bool isData) {
  Level half{std::max(1, level.width / 2), std::max(1, level.height / 2), {}};
  forEachPixel(half.width, half.height, [&](int x, int y) {
    Color sum;
    double area = 0;
    forEachCovered(level.width, level.height, x, y, half.width, half.height,
                   [&](int texel, double part) {
                     if (!left.of.empty()) part *= left.of[texel];
                     sum += level.texels[texel] * part;
                     area += part;
                   });
    half.texels.push_back(asCodes(area > 0 ? sum / area : Color{}, isData));
  });
  return half;
}

Color MipChain::Level::texel(int x, int y) const {
  return texels[wrapped(y, height) * width + wrapped(x, width)];
}

Color MipChain::Level::mixed(double u, double v) const {
  return bilinear(u * width, (1 - v) * height, [&](int x, int y) { return texel(x, y); });
}

const MipChain::Level& MipChain::level(int number) const {
  return levels_[std::min<std::size_t>(number, levels_.size() - 1)];
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
