// From samples to pixels, and from pixels to display codes.
#include "reference/update_image.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/small_scenes.h"
#include "sampling/sample_pattern.h"

namespace whit::reference {
namespace {

using test::SceneBuilder;

// Hard case H76: the mean of equal samples is exact.
TEST(Pixel, MeanOfEqualSamplesIsExact) {
  SceneBuilder builder;
  builder.sky(0.1f);
  builder.add(test::floorAt(-1, 1, 0));
  const Scene scene = builder.build();
  const BruteForce bruteForce(scene);

  Camera up;
  up.at = {0, 9, 4};
  const CameraFrame frame = makeCameraFrame(up, 8, 8);

  for (const int spp : {1, 2, 3, 5, 16, 1000}) {
    Settings settings;
    settings.options.spp = spp;
    RayCounts counts;
    EXPECT_EQ(Tracer(scene, bruteForce, settings).pixel(frame, 3, 4, counts), RgbD(Rgb(0.1f)));
    EXPECT_EQ(counts[RayKind::primary], static_cast<std::uint64_t>(spp));
  }
}

// A pixel that an edge crosses shows the share of samples on the bright side.
TEST(Pixel, IsTheMeanOverTheSamplePattern) {
  SceneBuilder builder;
  Material glowing = test::blackMaterial();
  glowing.emission = Rgb(1.0f);

  // The glowing surface is everything left of x = 0, at distance 5.
  builder.add(test::quad({-9, -9, 0}, {0, -9, 0}, {0, 9, 0}, {-9, 9, 0}, builder.add(glowing)));
  const Scene scene = builder.build();
  const BruteForce bruteForce(scene);

  // The number of columns is odd, so that the edge crosses the middle of column 4.
  const CameraFrame frame = makeCameraFrame(Camera{}, 9, 9);

  for (const int spp : {4, 7, 64}) {
    Settings settings;
    settings.options.spp = spp;

    int left = 0;
    for (const Vec2f& sample : samplePattern(spp)) left += sample.x <= 0.5f;
    RayCounts counts;
    const Tracer tracer(scene, bruteForce, settings);
    EXPECT_NEAR(tracer.pixel(frame, 4, 4, counts).x, static_cast<double>(left) / spp, 1e-14);
    EXPECT_EQ(tracer.pixel(frame, 3, 4, counts).x, 1);
    EXPECT_EQ(tracer.pixel(frame, 5, 4, counts).x, 0);
  }
}

// The formula of IEC 61966-2-1 again: 12.92 x up to 0.0031308, then 1.055 x^(1 / 2.4) - 0.055.
TEST(UpdateImage, CodesFollowTheFormula) {
  const auto code = [](double x) {
    const double s = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    return static_cast<std::uint32_t>(std::lround(255 * s));
  };

  const RenderOptions plain;
  for (const float x : {0.0f, 0.001f, 0.003f, 0.0032f, 0.18f, 0.5f, 0.9f, 1.0f}) {
    const double value{x};
    EXPECT_EQ(updateImage(plain, {x, 1, 0}), code(value) | 255u << 8) << x;
    EXPECT_EQ(updateImage(plain, {0, x, 7}), code(value) << 8 | 255u << 16) << x;
  }

  EXPECT_EQ(updateImage(plain, {0.18f, 0.5f, -1}), 118u | 188u << 8);
  EXPECT_EQ(updateImage(plain, {std::nanf(""), 2, 0}), 255u << 8);
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
