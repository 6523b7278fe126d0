#include "scene/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
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
  double worst = 0;
  for (int code = 0; code < 256; ++code) {
    const auto linear = static_cast<float>(srgbToLinear(code / 255.0));
    const Rgb decoded = decodeColorTexel(encodeColorTexel(Rgb(linear)));
    EXPECT_EQ(decoded.x, decoded.y);
    EXPECT_EQ(decoded.x, decoded.z);

    const double back = 255 * linearToSrgb(decoded.x);
    EXPECT_EQ(std::lround(back), code);
    worst = std::max(worst, std::abs(back - code));
  }

  EXPECT_LE(worst, kCodeTolerance);
}

TEST(ColorTexel, BlackAndWhiteAreExact) {
  EXPECT_EQ(decodeColorTexel(encodeColorTexel(Rgb(0.0f))), Rgb(0.0f));
  EXPECT_EQ(decodeColorTexel(encodeColorTexel(Rgb(1.0f))), Rgb(1.0f));
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
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(encodeColorTexel({nan, -1, inf}), 0x3ffu << 20);
  EXPECT_EQ(encodeColorTexel({-inf, 7, -0.0f}), 0x3ffu << 10);
  EXPECT_EQ(encodeDataTexel(nan, -1, inf, 2), 0xffff0000u);
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

    const double bound = std::max(static_cast<double>(largest) * kOfTheLargest, 0x1p-25);
    for (int c = 0; c < 3; ++c) {
      ASSERT_NEAR(static_cast<double>(got[c]), static_cast<double>(wanted[c]), bound) << i;
    }
  }
}

TEST(RadianceTexel, KeepsWhatNineBitsHold) {
  for (const float x :
       {0.0f, 0x1p-24f, 0.25f, 1.0f, 8.0f, 511.0f, 1000.0f, kLargestRadianceTexel}) {
    EXPECT_EQ(decodeRadianceTexel(encodeRadianceTexel(Rgb(x))), Rgb(x));
  }
  EXPECT_EQ(decodeRadianceTexel(encodeRadianceTexel({8, 0.5f, 3})), (Rgb{8, 0.5f, 3}));

  // 511.75 is rounded up to the next power of two.
  EXPECT_EQ(decodeRadianceTexel(encodeRadianceTexel(Rgb(511.75f))), Rgb(512.0f));
  EXPECT_EQ(encodeRadianceTexel({8, 0.5f, 3}), 256u | 16u << 9 | 96u << 18 | 19u << 27);
}

TEST(RadianceTexel, OutOfRangeAndNanAreClamped) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(decodeRadianceTexel(encodeRadianceTexel({nan, -1, inf})),
            (Rgb{0, 0, kLargestRadianceTexel}));
  EXPECT_EQ(decodeRadianceTexel(encodeRadianceTexel({1e30f, 65536, 0})),
            (Rgb{kLargestRadianceTexel, kLargestRadianceTexel, 0}));
}

TEST(DataTexel, EightBitsAChannel) {
  for (std::uint32_t code = 0; code < 256; ++code) {
    const float x = static_cast<float>(code) / 255;
    EXPECT_EQ(encodeDataTexel(x, 0, 0, 1), code | 0xff000000u);
    EXPECT_EQ(encodeDataTexel(0, x, x, 0), code << 8 | code << 16);
  }
}

TEST(Srgb, Anchors) {
  EXPECT_EQ(srgbToLinear(0), 0);
  EXPECT_EQ(srgbToLinear(1), 1);
  EXPECT_NEAR(linearToSrgb(1), 1, 1e-15);
  // ((0.5 + 0.055) / 1.055)^2.4, and middle gray.
  EXPECT_NEAR(srgbToLinear(0.5), 0.21404114048223255, 1e-15);
  EXPECT_NEAR(linearToSrgb(0.18), 0.46135612950044164, 1e-15);
  EXPECT_NEAR(srgbToLinear(0.04), 0.04 / 12.92, 1e-18);
}

TEST(Srgb, TheBranchesMeetAndTheCurvesUndoEachOther) {
  // The standard's constants leave a gap of 2e-8 between its branches.
  EXPECT_NEAR(linearToSrgb(std::nextafter(0.0031308, 1)), linearToSrgb(0.0031308), 3e-8);

  double previous = -1;
  for (int i = 0; i <= 4096; ++i) {
    const double x = i / 4096.0, y = srgbToLinear(x);
    EXPECT_GT(y, previous);
    EXPECT_NEAR(linearToSrgb(y), x, 3e-8);
    previous = y;
  }
}

}  // namespace
}  // namespace whit
