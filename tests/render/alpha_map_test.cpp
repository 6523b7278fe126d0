// Alpha masks: the table of bounds must never decide otherwise than the texels do.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "accel/alpha_filter.h"
#include "render/data_map.h"
#include "surfaces/texture_sampling.h"

namespace whit::test {
namespace {

Texture noise(int width, int height, Wrap wrap) {
  std::vector<float> alphas;
  std::mt19937 random(5);
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

// The reference looks texels up in double precision, by code of its own (TextureSampling).
TEST(AlphaMap, AgreesWithTheTexels) {
  // A coordinate is rounded by so much, in texels of the largest map, times the steepest slope of
  // alpha.
  constexpr double kCoordinate = 8 * 0x1p-24 * 4 * 100;

  int opaque = 0;
  for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp}) {
    for (const auto& [width, height] : {std::pair{100, 64}, std::pair{1, 1}, std::pair{7, 33}}) {
      const Texture texture = noise(width, height, wrap);
      const AlphaMap map(texture);
      std::mt19937 random(6);
      std::uniform_real_distribution<float> uniform(-1.5f, 2.5f);
      for (int i = 0; i < 20000; ++i) {
        const float u = uniform(random), v = uniform(random);
        const double alpha = sampleTexture(texture, double{u}, double{v}).x;
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
