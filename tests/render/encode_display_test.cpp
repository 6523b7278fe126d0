// The vector sRGB encoder against the scalar one, on every target.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "core/display.h"
#include "simd/kernels.h"
#include "stages/columns.h"

namespace whit::test {
namespace {

class EncodeDisplay : public testing::Test {
 protected:
  void TearDown() override { simd::chooseTarget("auto"); }
};

std::vector<std::uint32_t> codesOf(const std::vector<float>& values) {
  ColumnStore<RadianceColumns> radiance(values.size(), FeatureSet());
  for (std::size_t i = 0; i < values.size(); ++i) {
    radiance->rgb.x[i] = radiance->rgb.y[i] = radiance->rgb.z[i] = values[i];
  }

  std::vector<std::uint32_t> codes(values.size() + 16);
  simd::encodeDisplay({.radiance = *radiance, .n = values.size(), .codes = codes.data()});
  return codes;
}

void expectScalarCodes(const std::vector<float>& values) {
  for (const std::string& target : simd::availableTargets()) {
    ASSERT_TRUE(simd::chooseTarget(target));
    const std::vector<std::uint32_t> codes = codesOf(values);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto code = static_cast<std::uint32_t>(srgbCode(static_cast<double>(values[i])));
      ASSERT_EQ(codes[i], 0xFF000000u | code << 16 | code << 8 | code)
          << target << " at " << std::hexfloat << values[i];
    }
  }
}

// The values are the floats on both sides of every rounding, found by bisection over their bits.
TEST_F(EncodeDisplay, EveryCodeBeginsAtTheSameFloat) {
  std::vector<float> values;
  for (int code = 1; code < 256; ++code) {
    std::uint32_t below = 0, from = std::bit_cast<std::uint32_t>(1.0f);
    while (below + 1 < from) {
      const std::uint32_t middle = below + (from - below) / 2;
      (srgbCode(static_cast<double>(std::bit_cast<float>(middle))) >= code ? from : below) = middle;
    }

    values.push_back(std::bit_cast<float>(below));
    values.push_back(std::bit_cast<float>(from));
  }
  expectScalarCodes(values);
}

TEST_F(EncodeDisplay, FloatsOfAllSizesInSmallSteps) {
  std::vector<float> values;
  const auto one = std::bit_cast<std::uint32_t>(1.0f);
  for (std::uint32_t bits = 0; bits <= one; bits += 9973)
    values.push_back(std::bit_cast<float>(bits));
  expectScalarCodes(values);
}

TEST_F(EncodeDisplay, WhatIsNoColor) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  expectScalarCodes({0, -0.0f, -1, -kInf, kInf, std::nanf(""), -std::nanf(""), 1, 1.5f, 1e30f,
                     std::numeric_limits<float>::denorm_min()});
}

}  // namespace
}  // namespace whit::test
