// The vector sRGB encoder against the scalar one, on every target.
#include <gtest/gtest.h>

#include <bit>

#include "core/display.h"
#include "render/every_target.h"
#include "stages/columns.h"

namespace whit::test {
namespace {

std::vector<std::uint32_t> codesOf(const std::vector<float>& values) {
  ColumnStore<RadianceColumns> radiance(values.size(), FeatureSet());
  for (const auto i : indices(values)) {
    radiance->rgb.set(i, Rgb(values[i]));
  }

  std::vector<std::uint32_t> codes(values.size() + 16);
  simd::encodeDisplay({.radiance = *radiance, .n = values.size(), .codes = codes.data()});
  return codes;
}

void expectScalarCodes(const std::vector<float>& values) {
  forEachTarget([&](const std::string&) {
    const std::vector<std::uint32_t> codes = codesOf(values);
    for (const auto i : indices(values)) {
      const auto code = static_cast<std::uint32_t>(srgbCode(static_cast<double>(values[i])));
      ASSERT_EQ(codes[i], 0xFF000000u | code << 16 | code << 8 | code)
          << std::hexfloat << values[i];
    }
  });
}

// The values are the floats on both sides of every rounding, found by bisection over their bits.
TEST(EncodeDisplay, EveryCodeBeginsAtTheSameFloat) {
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

}  // namespace
}  // namespace whit::test
