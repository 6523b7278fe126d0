#include "scene/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/display.h"
#include "decoded_texel.h"

namespace whit {
namespace {

// Ten bits of a square root are steps of at most 0.36 sRGB codes (where the curve's straight part
// ends), so that the error is at most 0.18. Over the 256 codes that occur it is at most 0.157, at
// code 9.
constexpr double kCodeTolerance = 1.0 / 6;

TEST(ColorTexel, AllSrgbCodesComeBack) {
  for (int code = 0; code < 256; ++code) {
    const auto linear = static_cast<float>(srgbToLinear(code / 255.0));
    const Rgb decoded = decodeColorTexel(encodeColorTexel(Rgb(linear)));
    EXPECT_EQ(decoded, Rgb(decoded.x));
    EXPECT_NEAR(255 * linearToSrgb(decoded.x), code, kCodeTolerance);
  }
}

TEST(ColorTexel, ChannelsLieInOrderFromTheLowBits) {
  EXPECT_EQ(encodeColorTexel({1, 0, 0}), 0x3ffu);
  EXPECT_EQ(encodeColorTexel({0, 1, 0}), 0x3ffu << 10);
  EXPECT_EQ(encodeColorTexel({0, 0, 1}), 0x3ffu << 20);
  // sqrt(0.25) * 1023 = 511.5 is rounded away from zero.
  EXPECT_EQ(encodeColorTexel({0.25f, 0, 0}), 512u);
}

TEST(ColorTexel, EveryCodeRoundTrips) {
  for (std::uint32_t code = 0; code < 1024; ++code) {
    const std::uint32_t texel = code | (1023 - code) << 10 | code << 20;
    EXPECT_EQ(encodeColorTexel(decodeColorTexel(texel)), texel);
  }
}

TEST(Texel, OutOfRangeAndNanAreClamped) {
  EXPECT_EQ(encodeColorTexel({NAN, -1, INFINITY}), 0x3ffu << 20);
  EXPECT_EQ(encodeColorTexel({-INFINITY, 7, -0.0f}), 0x3ffu << 10);
  EXPECT_EQ(encodeDataTexel(NAN, -1, INFINITY, 2), 0xffff0000u);
}

// The error is half a code, and the largest channel has a code of at least 256.
constexpr double kOfTheLargest = 1.0 / 512;

TEST(RadianceTexel, IsWithinItsBoundFromBlackToTheLargest) {
  std::mt19937 random(1);
  const auto unit = [&] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
  for (int i = 0; i < 100000; ++i) {
    const float largest = std::min(std::ldexp(1 + unit(), i % 48 - 32), kLargestRadianceTexel);
    const Rgb wanted{largest * unit(), largest, largest * unit()};
    const Rgb got = decodeRadianceTexel(encodeRadianceTexel(wanted));

    const double bound = std::max(largest * kOfTheLargest, 0x1p-25);
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(got[c], wanted[c], bound) << i;
  }
}

Rgb throughRadianceTexel(const Rgb& radiance) {
  return decodeRadianceTexel(encodeRadianceTexel(radiance));
}

TEST(RadianceTexel, KeepsWhatNineBitsHold) {
  for (const float x :
       {0.0f, 0x1p-24f, 0.25f, 1.0f, 8.0f, 511.0f, 1000.0f, kLargestRadianceTexel}) {
    EXPECT_EQ(throughRadianceTexel(Rgb(x)), Rgb(x));
  }
  EXPECT_EQ(throughRadianceTexel({8, 0.5f, 3}), (Rgb{8, 0.5f, 3}));

  // 511.75 is rounded up to the next power of two.
  EXPECT_EQ(throughRadianceTexel(Rgb(511.75f)), Rgb(512.0f));
  EXPECT_EQ(encodeRadianceTexel({8, 0.5f, 3}), 256u | 16u << 9 | 96u << 18 | 19u << 27);
}

TEST(RadianceTexel, OutOfRangeAndNanAreClamped) {
  EXPECT_EQ(throughRadianceTexel({NAN, -1, INFINITY}), (Rgb{0, 0, kLargestRadianceTexel}));
  EXPECT_EQ(throughRadianceTexel({1e30f, 65536, 0}),
            (Rgb{kLargestRadianceTexel, kLargestRadianceTexel, 0}));
}

TEST(DataTexel, EightBitsAChannel) {
  for (std::uint32_t code = 0; code < 256; ++code) {
    const float x = static_cast<float>(code) / 255;
    EXPECT_EQ(encodeDataTexel(x, 0, 0, 1), code | 0xff000000u);
    EXPECT_EQ(encodeDataTexel(0, x, x, 0), code << 8 | code << 16);
  }
}

}  // namespace
}  // namespace whit
