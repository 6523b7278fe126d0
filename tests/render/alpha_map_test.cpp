// Alpha masks: the table of bounds must never decide otherwise than the texels do.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "accel/alpha_filter.h"
#include "render/data_map.h"
#include "render/wrapped_texel.h"

namespace whit::test {
namespace {

Texture noise(int width, int height, Wrap wrap, unsigned seed) {
  std::vector<float> alphas;
  std::mt19937 random(seed);
  for (int i = 0; i < width * height; ++i) {
    // The texture is mostly flat, so that bounds decide, and has borders where they must not.
    const int x = i % width, y = i / width;
    const bool solid = (x / 20 + y / 20) % 2 == 0;
    float alpha = solid ? 1 : 0;
    if (random() % 50 == 0) alpha = static_cast<float>(random() % 256) / 255;
    alphas.push_back(alpha);
  }

  Texture texture = dataMap(width, alphas);
  texture.wrapU = texture.wrapV = wrap;
  return texture;
}

// Bilinear alpha in double precision; mirrored coordinates are folded first.
double alphaAt(const Texture& texture, double u, double v) {
  const auto fold = [&](double s) {
    if (texture.wrapU != Wrap::mirror)
      return texture.wrapU == Wrap::clamp ? std::fmin(std::fmax(s, 0), 1) : s;

    const double phase = s - 2 * std::floor(s / 2);
    return std::fmin(phase, 2 - phase);
  };

  // v runs upwards, but the rows of texels run downwards.
  const double x = fold(u) * texture.width - 0.5, y = fold(1 - v) * texture.height - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const auto texel = [&](int dx, int dy) {
    const int column = wrappedTexel(x0 + dx, texture.width, texture.wrapU);
    const int row = wrappedTexel(y0 + dy, texture.height, texture.wrapV);
    return (texture.texels[static_cast<std::size_t>(row * texture.width + column)] & 255u) / 255.0;
  };

  const double fx = x - x0, fy = y - y0;
  return (texel(0, 0) * (1 - fx) + texel(1, 0) * fx) * (1 - fy) +
         (texel(0, 1) * (1 - fx) + texel(1, 1) * fx) * fy;
}

TEST(AlphaMap, AgreesWithTheTexels) {
  // A coordinate is rounded by so much, in texels of the largest map, times the steepest slope of
  // alpha.
  constexpr double kCoordinate = 8 * 0x1p-24 * 4 * 100;

  int opaque = 0;
  for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp}) {
    for (const auto& [width, height] : {std::pair{100, 64}, std::pair{1, 1}, std::pair{7, 33}}) {
      const Texture texture = noise(width, height, wrap, 5);
      const AlphaMap map(texture);
      std::mt19937 random(6);
      std::uniform_real_distribution<float> uniform(-1.5f, 2.5f);
      for (int i = 0; i < 20000; ++i) {
        const float u = uniform(random), v = uniform(random);
        const double alpha = alphaAt(texture, static_cast<double>(u), static_cast<double>(v));
        for (const float cutoff : {0.25f, 0.5f, 1.0f}) {
          const double margin = alpha - static_cast<double>(cutoff);
          if (std::fabs(margin) < kCoordinate) continue;  // too near to tell

          const bool seen = map.marginAt(u, v, cutoff) >= 0;
          ASSERT_EQ(seen, margin > 0) << u << ' ' << v << ' ' << width << ' ' << cutoff;
          opaque += seen;
        }
      }
    }
  }

  EXPECT_GT(opaque, 10000);
}

// Where the cutoff varies, equal texels make close calls, too.
TEST(AlphaMap, KnowsCloseCallsOfEqualTexels) {
  const AlphaMap map(dataMap(1, {1}));

  const float cutoff = 1 - kCloseCall / 2;
  EXPECT_EQ(map.marginAt(0.5f, 0.5f, cutoff), 1);
  const float margin = map.marginAt(0.5f, 0.5f, cutoff, true);
  EXPECT_GT(margin, 0);
  EXPECT_LT(margin, kCloseCall);
}

}  // namespace
}  // namespace whit::test
