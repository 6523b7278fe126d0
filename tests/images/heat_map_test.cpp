#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/display.h"
#include "inspect/metrics.h"

namespace whit {
namespace {

// Returns the linear color of a pixel, which is opaque.
Rgb at(const DisplayImage& image, int x, int y) {
  const std::uint8_t* p = &image.rgba[4 * cellAt(x, y, image.width)];
  EXPECT_EQ(p[3], 255);
  const auto& linear = linearOfCodes();
  return {linear[p[0]], linear[p[1]], linear[p[2]]};
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
  const DisplayImage map = heatMap(a, b, 0, ToneCurve::none);
  EXPECT_EQ(map.width, 100);
  EXPECT_EQ(at(map, 0, 0), Rgb());
  for (int codes = 1; codes <= 16; ++codes)
    EXPECT_GT(luminance(at(map, codes, 0)), luminance(at(map, codes - 1, 0))) << codes;
  for (int x = 17; x < 100; ++x) EXPECT_EQ(at(map, x, 0), at(map, 16, 0));
  for (int x = 0; x < 100; ++x) EXPECT_EQ(at(map, x, 1), Rgb());
}

TEST(HeatMap, TakesTheWindowOnly) {
  const Image window(500, 500, {10, 10, 90, 13});
  const DisplayImage map = heatMap(window, window, 0, ToneCurve::none);
  EXPECT_EQ(map.width, 80);
  EXPECT_EQ(map.height, 3);
}

}  // namespace
}  // namespace whit
