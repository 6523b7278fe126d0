// Pictures that get more samples over time: the final picture, the pictures on the way, and the
// error that the sums of the samples estimate.
#include <gtest/gtest.h>

#include <cmath>

#include "render/pipeline_laws.h"
#include "render/renderer.h"

namespace whit::test {
namespace {

RenderOptions noisy(int spp) {
  RenderOptions o = smallOptions();
  o.spp = spp;
  o.glossy = 1;
  o.lightSamples = 2;
  return o;
}

using Accumulating = SceneTest;

// The samples are rendered in three ranges, and each range in two bands of columns.
TEST_P(Accumulating, AllSamplesMakeThePictureBitForBit) {
  const RenderOptions o = noisy(16);
  Renderer renderer(scene_, o);
  const Picture expected = render(renderer);
  const Camera camera = chooseCamera(scene_, o);
  Film whole = makeFilm(scene_, o);
  SampleSums sums(whole.image.window);
  const int middle = whole.image.width / 3;

  for (const SampleRange& part : {SampleRange{0, 1}, {1, 4}, {4, 16}}) {
    for (const auto& [left, right] : {std::pair{0, middle}, {middle, whole.image.width}}) {
      Film band;
      band.image =
          Image(whole.image.width, whole.image.height, Crop{left, 0, right, whole.image.height});
      renderer.render({.camera = camera, .film = band, .part = part, .sums = &sums});
      forEachPixel(band.image, [&](int x, int y) { whole.image.at(x, y) = band.image.at(x, y); });
    }
  }

  EXPECT_EQ(firstDifference(whole, expected), "");

  // The sums do not depend on the ranges either.
  SampleSums atOnce(whole.image.window);
  renderer.render({.camera = camera, .film = whole, .part = {0, 16}, .sums = &atOnce});
  EXPECT_EQ(sums.relativeError(16), atOnce.relativeError(16));
}

// The mean of some of the samples is a picture of the whole pixel: with more samples both the true
// and the estimated error fall.
TEST_P(Accumulating, FewerSamplesShowTheSameWithMoreNoise) {
  const RenderOptions o = noisy(64);
  Renderer renderer(scene_, o);
  const Picture best = render(renderer);

  const Camera camera = chooseCamera(scene_, o);
  Film film = makeFilm(scene_, o);
  SampleSums sums(film.image.window);
  double last = HUGE_VAL, lastSaid = HUGE_VAL;
  for (const SampleRange& part : {SampleRange{0, 4}, {4, 16}, {16, 48}}) {
    renderer.render({.camera = camera, .film = film, .part = part, .sums = &sums});
    const double rmse = compareImages(film.image, best.image).rmse;
    const double said = sums.relativeError(part.end);

    EXPECT_LT(rmse, last);
    EXPECT_LT(said, lastSaid);
    last = rmse;
    lastSaid = said;
  }
}

// Frames of different seeds differ by noise alone; without random numbers they are equal.
TEST_P(Accumulating, SeedsHaveNoiseOfTheirOwn) {
  Renderer renderer(scene_, noisy(1));
  const Picture first = render(renderer);
  renderer.setSeed(1);
  const Picture second = render(renderer);
  renderer.setSeed(0);
  EXPECT_EQ(firstDifference(first, render(renderer)), "");

  const bool random = renderer.plan().features.has(Feature::streams);
  EXPECT_EQ(first.image.pixels != second.image.pixels, random);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Accumulating, testing::Values("glossy", "whitted", "matte"));

// There are two pixels of two samples, 1 and 3, and 2 and 2. The standard errors of their means are
// 1 and 0, and the mean radiance is 2.
TEST(SampleSums, TellsTheStandardError) {
  SampleSums sums(Crop{5, 5, 7, 6});
  for (const double value : {1.0, 3.0}) {
    sums.at(5, 5).total += RgbD(value);
    sums.at(5, 5).squares += value * value;
    sums.at(6, 5).total += RgbD(2.0);
    sums.at(6, 5).squares += 4;
  }

  EXPECT_DOUBLE_EQ(sums.relativeError(2), 0.25);
  EXPECT_EQ(SampleSums(Crop{0, 0, 3, 3}).relativeError(2), 0);
}

}  // namespace
}  // namespace whit::test
