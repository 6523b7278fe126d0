#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/display.h"
#include "inspect/metrics.h"

namespace whit {
namespace {

using Color = std::array<int, 3>;

Color at(const DisplayImage& image, int x, int y) {
  const std::uint8_t* p =
      image.rgba.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                               static_cast<std::size_t>(x));
  EXPECT_EQ(p[3], 255);
  return {p[0], p[1], p[2]};
}

double luminance(const Color& c) {
  return 0.2126 * srgbToLinear(c[0] / 255.0) + 0.7152 * srgbToLinear(c[1] / 255.0) +
         0.0722 * srgbToLinear(c[2] / 255.0);
}

// Pixel x of the first row differs by x codes.
std::array<Image, 2> ramp(int width) {
  std::array<Image, 2> images = {Image(width, 2), Image(width, 2)};
  for (int x = 0; x < width; ++x)
    images[1].at(x, 0).y = static_cast<float>(srgbToLinear(std::min(x, 255) / 255.0));
  return images;
}

TEST(HeatMap, GrowsLighterUpToSixteenCodes) {
  const auto [a, b] = ramp(100);
  const DisplayImage map = heatMap(a, b);
  EXPECT_EQ(map.width, 100);
  EXPECT_EQ(at(map, 0, 0), (Color{0, 0, 0}));
  for (int codes = 1; codes <= 16; ++codes)
    EXPECT_GT(luminance(at(map, codes, 0)), luminance(at(map, codes - 1, 0))) << codes;
  for (int codes = 17; codes < 100; ++codes) EXPECT_EQ(at(map, codes, 0), at(map, 16, 0));
  for (int x = 0; x < 100; ++x) EXPECT_EQ(at(map, x, 1), (Color{0, 0, 0}));
}

TEST(HeatMap, TakesTheWindowOnly) {
  const DisplayImage map =
      heatMap(Image(500, 500, {10, 10, 90, 13}), Image(500, 500, {10, 10, 90, 13}));
  EXPECT_EQ(map.width, 80);
  EXPECT_EQ(map.height, 3);
}

}  // namespace
}  // namespace whit
