// HDR-FLIP against values worked out from the paper's definition.
#include "inspect/flip.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "flat_image.h"
#include "inspect/metrics.h"

namespace whit {
namespace {

// Narkowicz's curve as published, for x / 0.6 of ours.
double aces(double x) {
  const double v = 0.6 * x;
  return v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14);
}

TEST(HdrFlip, ToneCurveIsTheFitOfAces) {
  for (const double x : {0.0, 1e-3, 0.1, 0.5, 1.0, 2.0})
    EXPECT_NEAR(hdrFlipToneCurve(x), std::min(aces(x), 1.0), 1e-12) << x;
  EXPECT_EQ(hdrFlipToneCurve(1e9), 1);
  EXPECT_EQ(hdrFlipToneCurve(-1), 0);
}

// The first exposure takes the brightest pixel to 0.85, the last one the median pixel.
TEST(HdrFlip, ExposuresSpanBrightestToMedian) {
  Image image = flat(5, 3, Rgb(0.25f));
  image.at(2, 1) = Rgb(16);
  const HdrFlip flip(image);
  const std::vector<double>& e = flip.exposures();
  EXPECT_NEAR(aces(16 * std::exp2(e.front())), 0.85, 1e-6);
  EXPECT_NEAR(aces(0.25 * std::exp2(e.back())), 0.85, 1e-6);
  EXPECT_EQ(e.size(), 6u);  // log2(16 / 0.25) stops
  for (std::size_t i = 1; i < e.size(); ++i) EXPECT_NEAR(e[i] - e[i - 1], 6.0 / 5, 1e-9);
}

// Gray 1 against gray 0.5: one exposure, at which they are shown as 0.85 and aces(x / 2), where
// aces(x) = 0.85. Of two grays the redistributed distance is that of their lightness alone:
// (0.95 / 0.4) (dL / Lmax)^0.7 with Lmax the Hunt distance of green and blue, 203.4 (its 0.7th
// power is 41.27); without an edge nothing else counts.
TEST(HdrFlip, TwoGraysByHand) {
  double low = 0, high = 100;
  for (int i = 0; i < 200; ++i) (aces((low + high) / 2) < 0.85 ? low : high) = (low + high) / 2;
  const auto lightness = [](double y) { return 116 * std::cbrt(y) - 16; };
  const double distance = lightness(0.85) - lightness(aces(low / 2));
  const HdrFlip flip(flat(8, 8, Rgb(1)));
  const double largest = 41.270;
  const double expected = 0.95 * std::pow(distance, 0.7) / (0.4 * largest);
  EXPECT_NEAR(flip.mean(flat(8, 8, Rgb(0.5f))), expected, 1e-3);
}

// Both are white on a display: FLIP sees nothing, HDR-FLIP does.
TEST(HdrFlip, SeesWhatTheDisplayClips) {
  Image a = flat(24, 16, Rgb(0.2f)), b = a;
  for (int x = 8; x < 16; ++x) a.at(x, 8) = Rgb(4), b.at(x, 8) = Rgb(8);
  EXPECT_EQ(compareImages(b, a).flipMean, 0);
  const std::vector<float> map = HdrFlip(a).map(b);
  EXPECT_GT(map[8 * 24 + 12], 0.1f);
}

// Exposures follow the reference: whatever the unit of radiance, the difference is the same.
TEST(HdrFlip, DoesNotDependOnTheUnit) {
  Image a = flat(20, 12, Rgb(0.3f, 0.2f, 0.1f)), b = a;
  b.at(10, 6) = Rgb(2, 0.1f, 0.4f);
  const double mean = HdrFlip(a).mean(b);
  for (Image* image : {&a, &b})
    for (Rgb& pixel : image->pixels) pixel *= 1024.0f;
  EXPECT_GT(mean, 1e-4);
  EXPECT_NEAR(HdrFlip(a).mean(b), mean, 1e-6);
}

TEST(HdrFlip, EqualImagesDoNotDiffer) {
  Image a = flat(9, 7, Rgb(0.3f));
  a.at(4, 4) = Rgb(50, 0, 1);
  EXPECT_EQ(HdrFlip(a).mean(a), 0);
  EXPECT_EQ(HdrFlip(flat(4, 4, Rgb(0))).mean(flat(4, 4, Rgb(0))), 0);
}

TEST(HdrFlip, OddInputIsAnErrorOrCountsAsBlack) {
  const HdrFlip flip(flat(6, 4, Rgb(1)));
  EXPECT_THROW(flip.mean(flat(4, 6, Rgb(1))), Error);
  Image broken = flat(6, 4, Rgb(1)), black = broken;
  broken.at(2, 2) = Rgb(std::nanf(""), 1, 1);
  black.at(2, 2) = Rgb(0);
  EXPECT_EQ(flip.map(broken), flip.map(black));
}

}  // namespace
}  // namespace whit
