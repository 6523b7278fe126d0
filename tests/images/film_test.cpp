// The precision that a picture is kept in.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/display.h"

namespace whit {
namespace {

TEST(RoundedToHalf, KeepsHalvesAndRoundsTiesToEven) {
  for (const float x : {0.0f, 1.0f, -0.375f, 65504.0f, 0x1p-14f, 0x1p-24f, 1 + 0x1p-10f}) {
    EXPECT_EQ(roundedToHalf(x), x);
  }
  EXPECT_EQ(roundedToHalf(1 + 0x1p-11f), 1.0f);
  EXPECT_EQ(roundedToHalf(1 + 3 * 0x1p-11f), 1 + 0x1p-9f);
  EXPECT_EQ(roundedToHalf(1 + 0x1.1p-11f), 1 + 0x1p-10f);
  EXPECT_EQ(roundedToHalf(2 - 0x1p-20f), 2.0f);
  // Subnormal halves are multiples of 2^-24.
  EXPECT_EQ(roundedToHalf(0x1.8p-24f), 0x1p-23f);
  EXPECT_EQ(roundedToHalf(0x1p-25f), 0.0f);
}

TEST(RoundedToHalf, StaysFiniteAndKeepsWhatIsNot) {
  EXPECT_EQ(roundedToHalf(1e9f), 65504.0f);
  EXPECT_EQ(roundedToHalf(-65519.0f), -65504.0f);
  EXPECT_TRUE(std::isnan(roundedToHalf(std::nanf(""))));
  EXPECT_TRUE(std::isinf(roundedToHalf(std::numeric_limits<float>::infinity())));
}

// Half an ulp of an 11-bit significand.
TEST(RoundedToHalf, ErrsByAtMostHalfAnUlp) {
  for (float x = 0x1p-14f; x < 60000.0f; x *= 1.0137f) {
    EXPECT_LE(std::fabs(roundedToHalf(x) - x), x * 0x1p-11f) << x;
  }
}

TEST(KeptAs, EightBitsAreDisplayCodes) {
  for (int code = 0; code < 256; ++code) {
    EXPECT_EQ(srgbCode(static_cast<double>(linearOfCode(code))), code);
  }
  const Rgb kept = quantized(FilmPrecision::eightBit, Rgb(0.5f, -1, 3));
  EXPECT_EQ(kept.x, linearOfCode(188));  // sRGB of 1/2 is 0.7354, times 255: 187.5
  EXPECT_EQ(kept.y, 0.0f);
  EXPECT_EQ(kept.z, 1.0f);
  const Rgb odd(0.1f, 1e-9f, 7);
  EXPECT_EQ(quantized(FilmPrecision::single, odd), odd);
}

}  // namespace
}  // namespace whit
