// The mean of passes and its standard error, where both have a closed form.
#include "accuracy/reference_pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace whit::accuracy {
namespace {

Image flat(float value) {
  Image image(4, 3, Crop{0, 0, 4, 3});
  for (Rgb& pixel : image.pixels) pixel = {value, value, value};
  return image;
}

// The passes are 1, 2, 3 and 4: the variance of a pass is 5/3, and that of the mean of four passes
// is a quarter of it.
TEST(PassMean, OfFourFlatPictures) {
  PassMean passes;
  for (const float value : {1.0f, 2.0f, 3.0f, 4.0f}) passes.add(flat(value));
  EXPECT_EQ(passes.mean().at(3, 2), Rgb(2.5f));
  EXPECT_EQ(passes.half(false).at(0, 0), Rgb(2.0f));
  EXPECT_EQ(passes.half(true).at(0, 0), Rgb(3.0f));
  EXPECT_DOUBLE_EQ(passes.standardError(), std::sqrt(5.0 / 12));
  EXPECT_DOUBLE_EQ(passes.meanRadiance(), 2.5);
}

TEST(PassMean, EqualPassesHaveNoError) {
  PassMean passes;
  for (int i = 0; i < 3; ++i) passes.add(flat(0.7f));
  EXPECT_EQ(passes.standardError(), 0);
  EXPECT_EQ(passes.mean().pixels, flat(0.7f).pixels);
}

// One channel of one of twelve pixels is 0 in the first pass and 2 in the second. Its variance is
// 2, that of its mean is 1, and the mean over the 36 values of the picture is 1/36.
TEST(PassMean, IsTheRootMeanSquareOverPixelsAndChannels) {
  PassMean passes;
  Image second = flat(0);
  second.at(1, 1).y = 2;
  passes.add(flat(0));
  passes.add(second);
  EXPECT_DOUBLE_EQ(passes.standardError(), std::sqrt(1.0 / 36));
}

// The passes are normally distributed noise, and the error that is stated is that of their mean.
// With 30,000 values both are known within one or two per cent; a wrong power of the number of
// passes would be off by a factor of 4.
TEST(PassMean, TellsWhatTheMeanIsOffBy) {
  std::mt19937 random(3);
  std::normal_distribution<float> noise(10, 2);
  Image pass(100, 100, Crop{0, 0, 100, 100});
  PassMean passes;
  constexpr int kPasses = 16;

  for (int i = 0; i < kPasses; ++i) {
    for (Rgb& pixel : pass.pixels) pixel = {noise(random), noise(random), noise(random)};
    passes.add(pass);
  }

  double squares = 0;
  for (const Rgb& pixel : passes.mean().pixels) {
    for (const float value : {pixel.x, pixel.y, pixel.z}) {
      squares += (double{value} - 10) * (double{value} - 10);
    }
  }

  const double off = std::sqrt(squares / 30000);
  // The noise has a standard deviation of 2.
  EXPECT_NEAR(passes.standardError(), 2 / std::sqrt(double{kPasses}), 0.01);
  EXPECT_NEAR(passes.standardError() / off, 1, 0.03);
}

}  // namespace
}  // namespace whit::accuracy
