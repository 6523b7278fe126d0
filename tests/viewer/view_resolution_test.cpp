// The scale that holds a frame rate. A frame may take 1000 / 60 = 16.7 ms unless a test has another
// rate.
#include <gtest/gtest.h>

#include <vector>

#include "core/options.h"
#include "viewer/session/resolution_control.h"

namespace whit::view {
namespace {

constexpr double kPixels = 1e6;

// Returns a control that has seen many frames of `ms` for the whole window.
ResolutionControl learned(double ms, double rate = kDefaultRate) {
  ResolutionControl control(rate, 1);
  for (int i = 0; i < 100; ++i) control.learn(ms, kPixels);
  return control;
}

// Returns the scale that the control stays at.
double scaleOf(ResolutionControl& control) {
  for (std::size_t i = 0; i < kScales.size(); ++i) control.moving(kPixels);
  return control.moving(kPixels).scale;
}

TEST(ResolutionControl, BeginsWithWhatIsSoonThere) {
  ResolutionControl control(kDefaultRate, 3);
  EXPECT_EQ(control.moving(kPixels), (Sharpness{kScales.back(), 1}));
}

TEST(ResolutionControl, FewCoresAreAskedForLess) {
  EXPECT_EQ(defaultRate(2), 30);
  EXPECT_EQ(defaultRate(4), 30);
  EXPECT_EQ(defaultRate(5), 60);
}

TEST(ResolutionControl, TakesTheFinestScaleThatHoldsTheRate) {
  ResolutionControl slow = learned(100);
  EXPECT_EQ(scaleOf(slow), 0.375);  // 14.1 ms; 0.4375 would take 19
  ResolutionControl patient = learned(100, kLeastRate);
  EXPECT_EQ(scaleOf(patient), 0.6875);  // 47 ms of 50; 0.75 would take 56
  ResolutionControl fast = learned(10);
  EXPECT_EQ(scaleOf(fast), 1);
  ResolutionControl hopeless = learned(1e6);
  EXPECT_EQ(scaleOf(hopeless), kScales.back());
}

TEST(ResolutionControl, SamplesGoBeforeResolution) {
  ResolutionControl control(kDefaultRate, 16);
  const auto chosen = [&](double msForOneSample) {
    for (int i = 0; i < 100; ++i) control.learn(msForOneSample, kPixels);
    for (std::size_t i = 0; i < 2 * kScales.size(); ++i) control.moving(kPixels);
    return control.moving(kPixels);
  };

  EXPECT_EQ(chosen(0.5), (Sharpness{1, 16}));
  EXPECT_EQ(chosen(3), (Sharpness{1, 4}));  // 12 ms; 8 would take 24
  EXPECT_EQ(chosen(16), (Sharpness{1, 1}));
  EXPECT_EQ(chosen(100), (Sharpness{0.375, 1}));
}

// A sample costs 30 ms with sampled rays, of which plain ones take a tenth.
TEST(ResolutionControl, SampledRaysGoBeforeResolution) {
  ResolutionControl control(kDefaultRate, 1);
  control.setSamples(1, true);
  control.learn(3, kPixels, true);
  for (int i = 0; i < 100; ++i) control.learn(30, kPixels);
  for (int i = 0; i < 3; ++i) control.moving(kPixels);
  EXPECT_EQ(control.moving(kPixels), (Sharpness{1, 1, true}));

  // They come back where there is time for them, and resolution goes after they have gone.
  for (int i = 0; i < 100; ++i) control.learn(1, kPixels, true);
  EXPECT_EQ(control.moving(kPixels), (Sharpness{1, 1, false}));
  for (int i = 0; i < 100; ++i) control.learn(100, kPixels, true);
  EXPECT_EQ(control.moving(kPixels), (Sharpness{0.375, 1, true}));
}

// Until a sample with them was traced, they are only tried where they seem to be affordable.
TEST(ResolutionControl, SampledRaysAreExpectedToCostMore) {
  const auto first = [](double plainMs) {
    ResolutionControl control(kDefaultRate, 1);
    control.setSamples(1, true);
    control.learn(plainMs, kPixels, true);
    return control.moving(kPixels);
  };
  EXPECT_TRUE(first(8).plain);
  EXPECT_FALSE(first(2).plain);
}

TEST(ResolutionControl, DoesNotFlutter) {
  ResolutionControl control = learned(15.5);
  EXPECT_EQ(scaleOf(control), 1);
  for (int i = 0; i < 100; ++i) control.learn(20, kPixels);
  EXPECT_EQ(scaleOf(control), 0.875);

  // The scale 0.9375 would take 15.8 ms. It would hold the rate, but so barely that the control
  // does not return to it.
  for (int i = 0; i < 100; ++i) control.learn(18, kPixels);
  EXPECT_EQ(scaleOf(control), 0.875);

  for (int i = 0; i < 100; ++i) control.learn(10, kPixels);
  EXPECT_EQ(scaleOf(control), 1);
}

TEST(ResolutionControl, RatesStayWithinLimits) {
  EXPECT_EQ(ResolutionControl(1, 1).rate(), kLeastRate);
  EXPECT_EQ(ResolutionControl(1e9, 1).rate(), kLargestRate);
}

TEST(ResolutionControl, IgnoresFramesWithoutTime) {
  ResolutionControl control = learned(10);
  control.learn(0, kPixels);
  control.learn(10, 0);
  EXPECT_EQ(scaleOf(control), 1);
}

// Returns the steps of a picture at rest, which begins with nothing or with a picture of
// `shownScale`.
std::vector<Sharpness> stepsAtRest(ResolutionControl& control, bool supersample,
                                   double shownScale = 0) {
  control.startSharpening(kPixels, shownScale);
  std::vector<Sharpness> steps{control.still(supersample)};
  while (control.sharpen(supersample)) steps.push_back(control.still(supersample));
  return steps;
}

TEST(ResolutionControl, SharpensAtRestStepByStep) {
  using Steps = std::vector<Sharpness>;
  // A slow machine begins coarse, and each step has four times the pixels.
  ResolutionControl slow = learned(1e5);
  EXPECT_EQ(stepsAtRest(slow, true),
            (Steps{{0.125, 1}, {0.25, 1}, {0.5, 1}, {1, 1}, {1, 4}, {1, 16}}));
  EXPECT_EQ(stepsAtRest(slow, false), (Steps{{0.125, 1}, {0.25, 1}, {0.5, 1}, {1, 1}}));

  ResolutionControl middling = learned(150);  // 37 ms for a half
  EXPECT_EQ(stepsAtRest(middling, false), (Steps{{0.5, 1}, {1, 1}}));

  ResolutionControl fast = learned(10);
  EXPECT_EQ(stepsAtRest(fast, true), (Steps{{1, 1}, {1, 4}, {1, 16}}));
}

TEST(ResolutionControl, RestBeginsWithOneSample) {
  using Steps = std::vector<Sharpness>;
  ResolutionControl slow(kDefaultRate, 4);
  for (int i = 0; i < 100; ++i) slow.learn(1e5, kPixels);
  EXPECT_EQ(stepsAtRest(slow, false), (Steps{{0.125, 1}, {0.25, 1}, {0.5, 1}, {1, 1}, {1, 4}}));
}

TEST(ResolutionControl, WhatIsShownGetsNoCoarser) {
  ResolutionControl slow = learned(1e5);
  EXPECT_EQ(stepsAtRest(slow, false, 0.25).front().scale, 0.25);
  EXPECT_EQ(stepsAtRest(slow, false, 0.375).front().scale, 0.5);
  EXPECT_EQ(stepsAtRest(slow, false, 1).front().scale, 1);
}

TEST(ResolutionControl, ComparedPicturesHaveTheSamplesAskedFor) {
  ResolutionControl control = learned(10);
  stepsAtRest(control, true);
  EXPECT_EQ(control.still(true), (Sharpness{1, 16}));
  EXPECT_EQ(control.still(false), (Sharpness{1, 1}));
}

TEST(ResolutionControl, SampledRaysGetMoreSamples) {
  ResolutionControl control = learned(10);
  control.setNoisy(true);
  EXPECT_EQ(stepsAtRest(control, false).back(), (Sharpness{1, 1}));
  EXPECT_EQ(stepsAtRest(control, true).back(), (Sharpness{1, 256}));
  control.setNoisy(false);
  EXPECT_EQ(control.still(true), (Sharpness{1, 16}));
}

TEST(ResolutionControl, SamplesStayWithinTheirLimit) {
  ResolutionControl control(kDefaultRate, kSppLimit);
  const Sharpness last = stepsAtRest(control, true).back();
  EXPECT_EQ(last, (Sharpness{1, kSppLimit}));
}

}  // namespace
}  // namespace whit::view
