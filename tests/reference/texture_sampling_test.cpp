// Bilinear lookups (hard cases H68, H69).
#include "surfaces/texture_sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "reference/small_scenes.h"
#include "rounding.h"

namespace whit::reference {
namespace {

using namespace test;

// Returns a texture whose channel r has these codes, the top row first; its values are exactly
// code / 255.
Texture ramp(int width, int height, const std::vector<std::uint32_t>& codes,
             Wrap wrap = Wrap::repeat) {
  Texture t = makeTexture(TexelFormat::data, width, height, codes);
  t.wrapU = t.wrapV = wrap;
  return t;
}

double codeAt(const Texture& t, double u, double v,
              TextureFilter filter = TextureFilter::bilinear) {
  return 255 * sampleTexture(t, u, v, filter).x;
}

struct Lookup {
  double u, v, code;
};

void expectCodes(const Texture& t, const std::vector<Lookup>& lookups,
                 TextureFilter filter = TextureFilter::bilinear) {
  for (const auto& [u, v, code] : lookups) {
    EXPECT_NEAR(codeAt(t, u, v, filter), code, kRounding) << u << ", " << v;
  }
}

TEST(TextureSampling, TexelCentersGiveTexelsAndBetweenThemItIsLinear) {
  expectCodes(ramp(2, 2, {10, 20, 30, 40}), {{0.25, 0.75, 10},
                                             {0.75, 0.75, 20},
                                             {0.25, 0.25, 30},
                                             {0.75, 0.25, 40},
                                             {0.5, 0.5, 25},
                                             {0.375, 0.75, 12.5},
                                             {0.25, 0.625, 15}});
  expectCodes(ramp(1, 1, {77}), {{0.123, 9.87, 77}});
  expectCodes(ramp(1, 2, {10, 30}), {{0.9, 0.5, 20}});
}

// A texel extends to the middle between its center and the next, also across the border of a
// repeated texture.
TEST(TextureSampling, NearestTexel) {
  expectCodes(ramp(4, 1, {0, 40, 80, 120}),
              {{0.01, 0.5, 0},
               {0.2499, 0.5, 0},
               {0.25, 0.5, 40},
               {0.9999, 0.5, 120},
               {-0.0001, 0.5, 120},
               {1.0001, 0.5, 0}},
              TextureFilter::nearest);
}

TEST(TextureSampling, RepeatJoinsTheBorders) {
  const Texture t = ramp(4, 1, {0, 40, 80, 120});
  expectCodes(t, {{0, 0.5, 60}, {1, 0.5, 60}});
  for (const double u : {0.0, 0.1328125, 0.5, 0.984375}) {  // exact sums in binary
    for (const double whole : {-7.0, 1.0, 1000.0}) {
      EXPECT_EQ(codeAt(t, u + whole, 0.5 + whole), codeAt(t, u, 0.5)) << u << " + " << whole;
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
  for (const double bad : {std::nan(""), kInfinity, -kInfinity, 1e30, -1e30, 1048577.0}) {
    EXPECT_EQ(codeAt(t, bad, 0.3), codeAt(t, 0, 0.3)) << bad;
    EXPECT_EQ(codeAt(t, 0.3, bad), codeAt(t, 0.3, 0)) << bad;
  }

  EXPECT_EQ(codeAt(t, 1048575.5, 0.5), codeAt(t, 0.5, 0.5));
}

TEST(TextureSampling, ClampHoldsTheBorder) {
  expectCodes(ramp(2, 2, {10, 20, 30, 40}, Wrap::clamp),
              {{-3, 0.75, 10}, {7, 0.75, 20}, {0.25, 9, 10}, {0.25, -9, 30}, {0.5, 0.75, 15}});
}

TEST(TextureSampling, MirrorRunsBackAndForth) {
  const Texture t = ramp(4, 1, {0, 40, 80, 120}, Wrap::mirror);
  expectCodes(t, {{1, 0.5, 120}, {0, 0.5, 0}});
  for (const double u : {0.0, 0.1, 0.5, 0.95}) {
    for (const double same : {2 - u, -u, u + 6}) {
      EXPECT_NEAR(codeAt(t, same, 0.5), codeAt(t, u, 0.5), 1e-10);
    }
  }
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
  expectNear(sampleTexture(t, 0, 0), {0.2, 0.4, 0.6});
}

}  // namespace
}  // namespace whit::reference
