// Encoding for display against the sRGB formula in long double, and the tone curves by hand.
#include "core/display.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace whit {
namespace {

using RgbaCodes = std::vector<std::uint8_t>;
using Grays = std::vector<float>;

// IEC 61966-2-1, written out again.
long double decode(long double v) {
  return v <= 0.04045L ? v / 12.92L : std::pow((v + 0.055L) / 1.055L, 2.4L);
}

TEST(Srgb, EveryCodeComesBack) {
  for (int code = 0; code < 256; ++code) {
    const double linear = srgbToLinear(code / 255.0);
    EXPECT_EQ(srgbCode(linear), code);
    EXPECT_EQ(srgbCode(double{static_cast<float>(linear)}), code)
        << "as textures and images hold it";
  }
}

// The code changes from k - 1 to k where 255 * srgb = k - 1/2. 1e-13 relative is far above the
// rounding of pow in double and far below the distance of two floats.
TEST(Srgb, CodesChangeAtTheTies) {
  for (int k = 1; k < 256; ++k) {
    const double tie = static_cast<double>(decode((k - 0.5L) / 255));
    EXPECT_EQ(srgbCode(tie * (1 - 1e-13)), k - 1);
    EXPECT_EQ(srgbCode(tie * (1 + 1e-13)), k);
  }
}

// Three roundings come before the power, which multiplies each of them by 2.4.
TEST(Srgb, DecodingFollowsTheFormula) {
  for (int code = 0; code < 256; ++code)
    EXPECT_NEAR(srgbToLinear(code / 255.0), static_cast<double>(decode(code / 255.0L)), 1e-15);
}

TEST(Srgb, OddValuesHaveCodes) {
  for (const double x : {std::nan(""), -1.0, -kInfinity, -0.0, 1e-310}) EXPECT_EQ(srgbCode(x), 0);
  for (const double x : {1.0, 7.0, kInfinity}) EXPECT_EQ(srgbCode(x), 255);
}

TEST(ToneCurve, NoneIsTheIdentity) {
  for (const double x : {0.0, 0.1, 1.0, 50.0}) EXPECT_EQ(applyToneCurve(ToneCurve::none, x), x);
}

TEST(ToneCurve, Reinhard) {
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 0.5}, {3.0, 0.75}, {kInfinity, 1.0}}) {
    EXPECT_EQ(applyToneCurve(ToneCurve::reinhard, x), y);
  }
}

// The values of the curve are worked out by hand.
// At 1: (0.15 + 0.05 + 0.004) / (0.15 + 0.5 + 0.06) - 1/15 = 0.204 / 0.71 - 1/15; at 11.2:
// (11.2 * (1.68 + 0.05) + 0.004) / (11.2 * (1.68 + 0.5) + 0.06) - 1/15 = 19.38 / 24.476 - 1/15.
TEST(ToneCurve, Filmic) {
  const double white = 19.38 / 24.476 - 1.0 / 15;
  const auto filmic = [](double x) { return applyToneCurve(ToneCurve::filmic, x); };
  EXPECT_NEAR(filmic(0), 0, 1e-15);
  EXPECT_NEAR(filmic(1), (0.204 / 0.71 - 1.0 / 15) / white, 1e-14);
  EXPECT_NEAR(filmic(11.2), 1, 1e-14);
  EXPECT_GT(filmic(kInfinity), 1);
}

TEST(ToDisplay, ExposureCurveAndWindow) {
  Image image(10, 10, {4, 5, 6, 6});
  image.at(4, 5) = Rgb(0.25f, 1, 0);
  image.at(5, 5) = Rgb(NAN, -1, INFINITY);

  const DisplayImage plain = toDisplay(image, 2, ToneCurve::none);
  EXPECT_EQ(plain.width, 2);
  EXPECT_EQ(plain.height, 1);
  EXPECT_EQ(plain.rgba, (RgbaCodes{255, 255, 0, 255, 0, 0, 255, 255}));

  // 0.25 and 1 at -1 EV are 1/8 and 1/2; Reinhard makes them 1/9 and 1/3, sRGB 0.3673 and 0.6126:
  // codes 93.7 and 156.2.
  const DisplayImage curved = toDisplay(image, -1, ToneCurve::reinhard);
  EXPECT_EQ(curved.rgba, (RgbaCodes{94, 156, 0, 255, 0, 0, 255, 255}));
}

// Returns a row of gray pixels, with their coverage, over the background.
DisplayImage over(const Grays& grays, const Grays& alpha, const RenderOptions& options) {
  Image image(static_cast<int>(grays.size()), 1);
  std::ranges::transform(grays, image.pixels.begin(), [](float gray) { return Rgb(gray); });
  return overBackground(image, alpha, options);
}

// Pixels are premultiplied: half of the first one is covered by white, and a quarter of the second
// one, and the last one has the color of the background.
TEST(OverBackground, MixesInLinearLightByCoverage) {
  // In linear light, 1/2 has the code 188, and 1/4 has 137.
  const Grays grays{0.5f, 0.25f, 0};
  RenderOptions options;
  options.background = {Background::Kind::color, {255, 0, 0}};
  const DisplayImage red = over(grays, {0.5f, 0.25f, 0}, options);
  EXPECT_EQ(red.rgba, (RgbaCodes{255, 188, 188, 255,  //
                                 255, 137, 137, 255,  //
                                 255, 0, 0, 255}));
  EXPECT_FALSE(red.hasAlpha);

  options.background = {Background::Kind::transparent};
  const DisplayImage clear = over(grays, {0.5f, 0.25f, 0}, options);
  EXPECT_EQ(clear.rgba, (RgbaCodes{255, 255, 255, 128,  //
                                   255, 255, 255, 64,   //
                                   0, 0, 0, 0}));
  EXPECT_TRUE(clear.hasAlpha);
}

// The exposure brightens the surfaces, and not the background.
TEST(OverBackground, IsNotExposed) {
  RenderOptions options;
  options.background = {Background::Kind::color, {128, 0, 0}};
  options.exposure.ev = 2;

  // The surfaces' own color is 1/8, which the exposure makes 1/2. The code 128 is 0.2159 in linear
  // light, so that red is 0.3579, whose code is 162; the other channels are 1/4.
  EXPECT_EQ(over({0.0625f}, {0.5f}, options).rgba, (RgbaCodes{162, 137, 137, 255}));
}

// Reinhard's curve makes 1/2 of 1, whose code is 188. The background keeps its codes.
TEST(OverBackground, CurvesTheSurfacesAlone) {
  RenderOptions options;
  options.toneCurve = ToneCurve::reinhard;
  options.background = {Background::Kind::color, {255, 128, 0}};

  EXPECT_EQ(over({1, 0}, {1, 0}, options).rgba, (RgbaCodes{188, 188, 188, 255, 255, 128, 0, 255}));
}

}  // namespace
}  // namespace whit
