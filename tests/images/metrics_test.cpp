#include "inspect/metrics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/display.h"
#include "flat_image.h"
#include "image_samples.h"

namespace whit {
namespace {

float ofCode(int code) { return static_cast<float>(srgbToLinear(code / 255.0)); }

TEST(Metrics, EqualImagesDoNotDiffer) {
  Image image(9, 5);
  for (const auto i : indices(image.pixels))
    image.pixels[i] = Rgb(static_cast<float>(i) / 45, 0.3f, static_cast<float>(i % 7));

  const ImageDifference d = compareImages(image, image);
  EXPECT_EQ(d.rmse, 0);
  EXPECT_EQ(d.psnrDb, kInfinity);
  EXPECT_EQ(d.flipMean, 0);
  EXPECT_EQ(d.maxCode, 0);
  EXPECT_EQ(d.energyRatio, 1);
  EXPECT_EQ(d.nonFinite, 0u);
}

// One of two pixels differs, in red by 0.5 and in blue by 0.25: 6 channels.
TEST(Metrics, LinearErrorsByHand) {
  Image a = flat(2, 1, {0.5f, 0.5f, 0.5f});
  const Image b = a;
  a.pixels[1] = Rgb(1.0f, 0.5f, 0.25f);

  const ImageDifference d = compareImages(a, b);
  EXPECT_DOUBLE_EQ(d.rmse, std::sqrt((0.25 + 0.0625) / 6));
  EXPECT_DOUBLE_EQ(d.relmse, (0.25 + 0.0625) / (0.25 + 0.01) / 6);
  EXPECT_DOUBLE_EQ(d.energyRatio, 3.25 / 3.0);
}

// Four pixels: equal, 1 code in blue, 2 codes in green, 10 codes in red and 3 in blue.
TEST(Metrics, CodesByHand) {
  const Image b = flat(4, 1, Rgb(ofCode(100)));
  Image a = b;
  a.pixels[1].z = ofCode(101);
  a.pixels[2].y = ofCode(98);
  a.pixels[3].x = ofCode(110);
  a.pixels[3].z = ofCode(97);

  const ImageDifference d = compareImages(a, b);
  EXPECT_EQ(d.maxCode, 10);
  EXPECT_EQ(d.pixelsGe1CodePct, 75);
  EXPECT_EQ(d.pixelsGe2CodesPct, 50);
  EXPECT_NEAR(d.psnrDb, 10 * std::log10(255.0 * 255.0 / ((1 + 4 + 100 + 9) / 12.0)), 1e-12);
}

TEST(Metrics, ExposureMovesTheCodesAndNotTheLinearErrors) {
  const Image a = flat(2, 2, Rgb(2.0f)), b = flat(2, 2, Rgb(4.0f));
  EXPECT_EQ(compareImages(a, b).maxCode, 0);  // both white
  const ImageDifference darker = compareImages(a, b, -2);
  EXPECT_EQ(darker.maxCode, 255 - 188);  // srgb(0.5) is code 187.5
  EXPECT_EQ(darker.rmse, 2);
  EXPECT_GT(compareImages(a, b, 0, ToneCurve::reinhard).maxCode, 0);
}

TEST(Metrics, PixelsThatAreNotFiniteAreCountedAndLeftOut) {
  Image a = flat(3, 1, Rgb(1)), b = flat(3, 1, Rgb(1));
  a.pixels[0].x = NAN;
  b.pixels[1].y = INFINITY;
  a.pixels[2].z = 0.5f;

  const ImageDifference d = compareImages(a, b);
  EXPECT_EQ(d.nonFinite, 2u);
  EXPECT_EQ(d.incomparable, 2u);
  EXPECT_EQ(compareImages(a, a).nonFinite, 1u);
  EXPECT_EQ(compareImages(a, a).incomparable, 0u);
  EXPECT_DOUBLE_EQ(d.rmse, std::sqrt(0.25 / 3));
  EXPECT_TRUE(std::isfinite(d.flipMean));

  // Without any finite pixel the errors are 0.
  const ImageDifference none = compareImages(flat(1, 1, Rgb(NAN)), flat(1, 1, Rgb(1)));
  EXPECT_EQ(none.nonFinite, 1u);
  EXPECT_EQ(none.rmse, 0);
}

TEST(Metrics, BlackReferences) {
  const Image black = flat(2, 1, Rgb(0)), gray = flat(2, 1, Rgb(0.1f));
  EXPECT_EQ(compareImages(black, black).energyRatio, 1);
  EXPECT_EQ(compareImages(gray, black).energyRatio, kInfinity);
  EXPECT_NEAR(compareImages(gray, black).relmse, 1, 1e-6);  // 0.01 / 0.01, 0.1 being a float
}

TEST(Metrics, SizesAndWindowsMustMatch) {
  const Image square(2, 2), first(2, 2, {0, 0, 1, 1}), last(2, 2, {1, 1, 2, 2});
  using Images = std::pair<Image, Image>;
  for (const Images& of : {Images{square, Image(2, 3)}, {first, last}, {Image(), Image()}}) {
    EXPECT_EQ(statusOf([&] { compareImages(of.first, of.second); }), ExitStatus::usage);
  }
  EXPECT_EQ(compareImages(last, last).rmse, 0);
}

}  // namespace
}  // namespace whit
