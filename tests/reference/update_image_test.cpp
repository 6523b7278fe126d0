// From samples to pixels, and from pixels to display codes.
#include "reference/update_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference/small_scenes.h"
#include "sampling/sample_pattern.h"

namespace whit::reference {
namespace {

using namespace test;

// A pixel that an edge crosses shows the share of samples on the bright side.
TEST(Pixel, IsTheMeanOverTheSamplePattern) {
  // The glowing surface is everything left of x = 0, at distance 5.
  const Scene scene =
      sceneOf(quad({-9, -9, 0}, {0, -9, 0}, {0, 9, 0}, {-9, 9, 0}), emittingMaterial(1));
  const BruteForce bruteForce(scene);

  // The number of columns is odd, so that the edge crosses the middle of column 4.
  const CameraFrame frame = makeCameraFrame(Camera{}, 9, 9);

  for (const int spp : {4, 7, 64}) {
    Settings settings;
    settings.options.spp = spp;

    const auto left = static_cast<int>(
        std::ranges::count_if(samplePattern(spp), [](const Vec2f& s) { return s.x <= 0.5f; }));
    RayCounts counts;
    const Tracer tracer(scene, bruteForce, settings);
    EXPECT_NEAR(tracer.pixel(frame, 4, 4, counts).x * spp, left, 1e-12);
    EXPECT_EQ(tracer.pixel(frame, 3, 4, counts).x, 1);
    EXPECT_EQ(tracer.pixel(frame, 5, 4, counts).x, 0);
  }
}

TEST(UpdateImage, PacksTheCodesOfItsColors) {
  const RenderOptions plain;
  EXPECT_EQ(updateImage(plain, {0.18f, 0.5f, -1}), 118u | 188u << 8);
  EXPECT_EQ(updateImage(plain, {std::nanf(""), 2, 0.5f}), 255u << 8 | 188u << 16);
}

TEST(UpdateImage, ExposesThenBendsThenEncodes) {
  RenderOptions o;
  o.exposure.ev = 1;
  EXPECT_EQ(updateImage(o, Rgb(0.25f)), updateImage(RenderOptions(), Rgb(0.5f)));
  o.toneCurve = ToneCurve::reinhard;  // Reinhard's 1 / (1 + 1)
  EXPECT_EQ(updateImage(o, Rgb(0.5f)), updateImage(RenderOptions(), Rgb(0.5f)));
}

TEST(UpdateImage, RunningMeansOfEqualSamplesStay) {
  RgbD mean;
  for (int taken = 1; taken <= 1000; ++taken) {
    addSample(mean, {0.1, 0.2, 0.3}, taken);
    ASSERT_EQ(mean, RgbD(0.1, 0.2, 0.3)) << taken;
  }

  addSample(mean, {1001.1, 0.2, 0.3}, 1001);
  EXPECT_NEAR(mean.x, 1.1, 1e-12);
}

}  // namespace
}  // namespace whit::reference
