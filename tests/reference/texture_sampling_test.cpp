// Bilinear lookups (hard cases H68, H69).
#include "surfaces/texture_sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "reference/small_scenes.h"
#include "rounding.h"

namespace whit::reference {
namespace {

using test::makeTexture;

// Returns a texture whose channel r has these codes; its values are exactly code / 255.
Texture ramp(int width, int height, const std::vector<int>& codes) {
  std::vector<std::uint32_t> texels;
  for (const int code : codes) texels.push_back(static_cast<std::uint32_t>(code));
  return makeTexture(TexelFormat::data, width, height, texels);
}

double codeAt(const Texture& t, double u, double v) { return 255 * sampleTexture(t, u, v).x; }

TEST(TextureSampling, TexelCentersGiveTexels) {
  const Texture t = ramp(2, 2, {10, 20, 30, 40});  // the top row first
  EXPECT_NEAR(codeAt(t, 0.25, 0.75), 10, kRounding);
  EXPECT_NEAR(codeAt(t, 0.75, 0.75), 20, kRounding);
  EXPECT_NEAR(codeAt(t, 0.25, 0.25), 30, kRounding);
  EXPECT_NEAR(codeAt(t, 0.75, 0.25), 40, kRounding);
}

TEST(TextureSampling, BetweenCentersIsLinear) {
  const Texture t = ramp(2, 2, {10, 20, 30, 40});
  EXPECT_NEAR(codeAt(t, 0.5, 0.5), 25, kRounding);
  EXPECT_NEAR(codeAt(t, 0.375, 0.75), 12.5, kRounding);
  EXPECT_NEAR(codeAt(t, 0.25, 0.625), 15, kRounding);
}

// A texel extends to the middle between its center and the next, also across the border of a
// repeated texture.
TEST(TextureSampling, NearestTexel) {
  const Texture t = ramp(4, 1, {0, 40, 80, 120});
  const auto nearest = [&](double u) {
    return 255 * sampleTexture(t, u, 0.5, TextureFilter::nearest).x;
  };

  EXPECT_NEAR(nearest(0.01), 0, kRounding);
  EXPECT_NEAR(nearest(0.2499), 0, kRounding);
  EXPECT_NEAR(nearest(0.25), 40, kRounding);
  EXPECT_NEAR(nearest(0.9999), 120, kRounding);

  EXPECT_NEAR(nearest(-0.0001), 120, kRounding);
  EXPECT_NEAR(nearest(1.0001), 0, kRounding);

  const Texture c = makeTexture(TexelFormat::color, 2, 1, {0u, 1023u});
  EXPECT_EQ(sampleTexture(c, 0.7, 0.5, TextureFilter::nearest), RgbD(1, 0, 0));
  EXPECT_EQ(sampleTexture(c, 0.3, 0.5, TextureFilter::nearest), RgbD(0, 0, 0));
}

TEST(TextureSampling, RepeatJoinsTheBorders) {
  const Texture t = ramp(4, 1, {0, 40, 80, 120});
  EXPECT_NEAR(codeAt(t, 0, 0.5), 60, kRounding);
  EXPECT_NEAR(codeAt(t, 1, 0.5), 60, kRounding);
  for (const double u : {0.0, 0.1328125, 0.5, 0.984375}) {  // exact sums in binary
    for (const double whole : {-7.0, 1.0, 1000.0}) {
      EXPECT_EQ(codeAt(t, u + whole, 0.5), codeAt(t, u, 0.5)) << u << " + " << whole;
      EXPECT_EQ(codeAt(t, u, 0.5 + whole), codeAt(t, u, 0.5));
    }
  }
}

// Here u - floor(u) rounds to exactly 1. The texel behind the last one is the first.
TEST(TextureSampling, TinyNegativeCoordinates) {
  const Texture t = ramp(4, 4, {0, 40, 80, 120, 1, 41, 81, 121, 2, 42, 82, 122, 3, 43, 83, 123});
  for (const double tiny : {-1e-17, -1e-300, -std::numeric_limits<double>::denorm_min()}) {
    EXPECT_NEAR(codeAt(t, tiny, tiny), codeAt(t, 0, 0), kRounding);
  }
  EXPECT_NEAR(codeAt(t, -1e-9, -1e-9), codeAt(t, 0, 0), 1e-6);
}

TEST(TextureSampling, HopelessCoordinatesCountAsZero) {
  const Texture t = ramp(3, 5, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15});
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {std::nan(""), infinity, -infinity, 1e30, -1e30, 1048577.0}) {
    EXPECT_EQ(codeAt(t, bad, 0.3), codeAt(t, 0, 0.3)) << bad;
    EXPECT_EQ(codeAt(t, 0.3, bad), codeAt(t, 0.3, 0)) << bad;
  }

  EXPECT_EQ(codeAt(t, 1048575.5, 0.5), codeAt(t, 0.5, 0.5));
}

TEST(TextureSampling, OneTexelWide) {
  EXPECT_NEAR(codeAt(ramp(1, 1, {77}), 0.123, 9.87), 77, kRounding);
  EXPECT_NEAR(codeAt(ramp(1, 2, {10, 30}), 0.9, 0.5), 20, kRounding);
}

TEST(TextureSampling, ClampHoldsTheBorder) {
  Texture t = ramp(2, 2, {10, 20, 30, 40});
  t.wrapU = t.wrapV = Wrap::clamp;
  EXPECT_NEAR(codeAt(t, -3, 0.75), 10, kRounding);
  EXPECT_NEAR(codeAt(t, 7, 0.75), 20, kRounding);
  EXPECT_NEAR(codeAt(t, 0.25, 9), 10, kRounding);
  EXPECT_NEAR(codeAt(t, 0.25, -9), 30, kRounding);
  EXPECT_NEAR(codeAt(t, 0.5, 0.75), 15, kRounding);
}

TEST(TextureSampling, MirrorRunsBackAndForth) {
  Texture t = ramp(4, 1, {0, 40, 80, 120});
  t.wrapU = Wrap::mirror;

  for (const double u : {0.0, 0.1, 0.5, 0.95}) {
    EXPECT_NEAR(codeAt(t, 2 - u, 0.5), codeAt(t, u, 0.5), 1e-10);
    EXPECT_NEAR(codeAt(t, -u, 0.5), codeAt(t, u, 0.5), 1e-10);
    EXPECT_NEAR(codeAt(t, u + 6, 0.5), codeAt(t, u, 0.5), 1e-10);
  }
  EXPECT_NEAR(codeAt(t, 1, 0.5), 120, kRounding);
  EXPECT_NEAR(codeAt(t, 0, 0.5), 0, kRounding);
}

// Between black and white lies half of the light, not half of the code.
TEST(TextureSampling, ColorsMixInLinearLight) {
  const Texture t = makeTexture(TexelFormat::color, 2, 1,
                                {encodeColorTexel(Rgb(0.0f)), encodeColorTexel({1, 0.25f, 0})});
  const RgbD half = sampleTexture(t, 0.5, 0.5);
  EXPECT_NEAR(half.x, 0.5, 1e-12);
  // 0.25 is coded as 512 of 1023, half a code off the exact root. The value is off by 2 * 0.5 * 0.5
  // / 1023.
  EXPECT_NEAR(half.y, 0.125, 0.00025);
  EXPECT_EQ(half.z, 0);
}

TEST(TextureSampling, DataChannelsAreInOrder) {
  const Texture t = makeTexture(TexelFormat::data, 1, 1, {encodeDataTexel(0.2f, 0.4f, 0.6f, 0.8f)});
  const RgbD s = sampleTexture(t, 0, 0);
  EXPECT_NEAR(s.x, 0.2, kRounding);
  EXPECT_NEAR(s.y, 0.4, kRounding);
  EXPECT_NEAR(s.z, 0.6, kRounding);
}

}  // namespace
}  // namespace whit::reference
