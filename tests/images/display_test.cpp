// Encoding for display against the sRGB formula in long double, and the tone curves by hand.
#include "core/display.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace whit {
namespace {

// IEC 61966-2-1, written out again.
long double decode(long double v) {
  return v <= 0.04045L ? v / 12.92L : std::pow((v + 0.055L) / 1.055L, 2.4L);
}

TEST(Srgb, EveryCodeComesBack) {
  for (int code = 0; code < 256; ++code) {
    EXPECT_EQ(srgbCode(srgbToLinear(code / 255.0)), code);
    // The code comes back also when the decoded value is rounded to float, as in textures and
    // images.
    EXPECT_EQ(srgbCode(static_cast<double>(static_cast<float>(srgbToLinear(code / 255.0)))), code);
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

TEST(Srgb, BranchesMeet) {
  EXPECT_NEAR(linearToSrgb(0.0031308), linearToSrgb(std::nextafter(0.0031308, 1)), 1e-7);
  EXPECT_NEAR(srgbToLinear(0.04045), srgbToLinear(std::nextafter(0.04045, 1)), 1e-8);
}

TEST(Srgb, IsMonotone) {
  int last = 0;
  for (int i = 0; i <= 100000; ++i) {
    const int code = srgbCode(i / 100000.0);
    EXPECT_GE(code, last);
    last = code;
  }
  EXPECT_EQ(last, 255);
}

TEST(Srgb, OddValuesHaveCodes) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(srgbCode(std::nan("")), 0);
  EXPECT_EQ(srgbCode(-1), 0);
  EXPECT_EQ(srgbCode(-kInfinity), 0);
  EXPECT_EQ(srgbCode(-0.0), 0);
  EXPECT_EQ(srgbCode(1e-310), 0);
  EXPECT_EQ(srgbCode(1), 255);
  EXPECT_EQ(srgbCode(7), 255);
  EXPECT_EQ(srgbCode(kInfinity), 255);
}

TEST(ToneCurve, NoneIsTheIdentity) {
  for (const double x : {0.0, 0.1, 1.0, 50.0}) EXPECT_EQ(applyToneCurve(ToneCurve::none, x), x);
}

TEST(ToneCurve, Reinhard) {
  EXPECT_EQ(applyToneCurve(ToneCurve::reinhard, 0), 0);
  EXPECT_EQ(applyToneCurve(ToneCurve::reinhard, 1), 0.5);
  EXPECT_EQ(applyToneCurve(ToneCurve::reinhard, 3), 0.75);
  EXPECT_EQ(applyToneCurve(ToneCurve::reinhard, std::numeric_limits<double>::infinity()), 1);
}

// The values of the curve are worked out by hand.
// At 1: (0.15 + 0.05 + 0.004) / (0.15 + 0.5 + 0.06) - 1/15 = 0.204 / 0.71 - 1/15; at 11.2:
// (11.2 * (1.68 + 0.05) + 0.004) / (11.2 * (1.68 + 0.5) + 0.06) - 1/15 = 19.38 / 24.476 - 1/15.
TEST(ToneCurve, Filmic) {
  const double white = 19.38 / 24.476 - 1.0 / 15;
  EXPECT_NEAR(applyToneCurve(ToneCurve::filmic, 0), 0, 1e-15);
  EXPECT_NEAR(applyToneCurve(ToneCurve::filmic, 1), (0.204 / 0.71 - 1.0 / 15) / white, 1e-14);
  EXPECT_NEAR(applyToneCurve(ToneCurve::filmic, 11.2), 1, 1e-14);
  EXPECT_GT(applyToneCurve(ToneCurve::filmic, std::numeric_limits<double>::infinity()), 1);
}

TEST(ToDisplay, ExposureCurveAndWindow) {
  Image image(10, 10, {4, 5, 6, 6});
  image.at(4, 5) = Rgb(0.25f, 1, 0);
  image.at(5, 5) = Rgb(std::nanf(""), -1, std::numeric_limits<float>::infinity());

  const DisplayImage plain = toDisplay(image, 2, ToneCurve::none);
  EXPECT_EQ(plain.width, 2);
  EXPECT_EQ(plain.height, 1);
  EXPECT_EQ(plain.rgba, (std::vector<std::uint8_t>{255, 255, 0, 255, 0, 0, 255, 255}));

  // 0.25 and 1 at -1 EV are 1/8 and 1/2; Reinhard makes them 1/9 and 1/3, sRGB 0.3673 and 0.6126:
  // codes 93.7 and 156.2.
  const DisplayImage curved = toDisplay(image, -1, ToneCurve::reinhard);
  EXPECT_EQ(curved.rgba, (std::vector<std::uint8_t>{94, 156, 0, 255, 0, 0, 255, 255}));
}

// Pixels are premultiplied: half of the first one is covered by white, and a quarter of the second
// one, and the last one has the color of the background.
TEST(OverBackground, MixesInLinearLightByCoverage) {
  Image image(3, 1);
  image.pixels = {Rgb(0.5f), Rgb(0.25f), Rgb(0.0f)};
  const std::vector<float> alpha{0.5f, 0.25f, 0};
  const auto over = [&](const Background& background) {
    RenderOptions options;
    options.background = background;
    return overBackground(image, alpha, options);
  };

  // In linear light, 1/2 has the code 188, and 1/4 has 137.
  const DisplayImage red = over({Background::Kind::color, {255, 0, 0}});
  EXPECT_EQ(red.rgba, (std::vector<std::uint8_t>{255, 188, 188, 255,  //
                                                 255, 137, 137, 255,  //
                                                 255, 0, 0, 255}));
  EXPECT_FALSE(red.hasAlpha);

  const DisplayImage clear = over({Background::Kind::transparent});
  EXPECT_EQ(clear.rgba, (std::vector<std::uint8_t>{255, 255, 255, 128,  //
                                                   255, 255, 255, 64,   //
                                                   0, 0, 0, 0}));
  EXPECT_TRUE(clear.hasAlpha);
}

// The exposure brightens the surfaces, and not the background.
TEST(OverBackground, IsNotExposed) {
  Image image(1, 1);
  image.pixels = {Rgb(0.0625f)};
  RenderOptions options;
  options.background = {Background::Kind::color, {128, 0, 0}};
  options.exposure.ev = 2;

  // The surfaces' own color is 1/8, which the exposure makes 1/2. The code 128 is 0.2159 in linear
  // light, so that red is 0.3579, whose code is 162; the other channels are 1/4.
  const std::vector<float> alpha{0.5f};
  EXPECT_EQ(overBackground(image, alpha, options).rgba,
            (std::vector<std::uint8_t>{162, 137, 137, 255}));
}

// Reinhard's curve makes 1/2 of 1, whose code is 188. The background keeps its codes.
TEST(OverBackground, CurvesTheSurfacesAlone) {
  Image image(2, 1);
  image.pixels = {Rgb(1.0f), Rgb(0.0f)};
  RenderOptions options;
  options.toneCurve = ToneCurve::reinhard;
  options.background = {Background::Kind::color, {255, 128, 0}};

  const std::vector<float> alpha{1, 0};
  EXPECT_EQ(overBackground(image, alpha, options).rgba,
            (std::vector<std::uint8_t>{188, 188, 188, 255, 255, 128, 0, 255}));
}

}  // namespace
}  // namespace whit
