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

TEST(ResolutionControl, MoreSamplesCostMore) {
  ResolutionControl control(kDefaultRate, 4);
  control.learn(100, 4 * kPixels);  // four samples a pixel
  EXPECT_EQ(scaleOf(control), 0.375);
}

TEST(ResolutionControl, FewerSamplesWhereTheCoarsestScaleIsNotEnough) {
  ResolutionControl control(kDefaultRate, 64);
  control.learn(1000, kPixels);
  // A 64th of the pixels takes 15.6 ms a sample, of which one fits.
  EXPECT_EQ(scaleOf(control), kScales.back());
  EXPECT_EQ(control.moving(kPixels), (Sharpness{kScales.back(), 1}));

  ResolutionControl quicker(kDefaultRate, 64);
  quicker.learn(100, kPixels);  // ten samples fit
  EXPECT_EQ(scaleOf(quicker), kScales.back());
  EXPECT_EQ(quicker.moving(kPixels), (Sharpness{kScales.back(), 10}));
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
  control.setSampled(true);
  EXPECT_EQ(stepsAtRest(control, false).back(), (Sharpness{1, 1}));
  EXPECT_EQ(stepsAtRest(control, true).back(), (Sharpness{1, 256}));
  control.setSampled(false);
  EXPECT_EQ(control.still(true), (Sharpness{1, 16}));
}

TEST(ResolutionControl, SamplesStayWithinTheirLimit) {
  ResolutionControl control(kDefaultRate, kSppLimit);
  const Sharpness last = stepsAtRest(control, true).back();
  EXPECT_EQ(last, (Sharpness{1, kSppLimit}));
}

}  // namespace
}  // namespace whit::view
