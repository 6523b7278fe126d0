// The scale that holds a frame rate. A frame may take 1000 / 60 = 16.7 ms unless said otherwise.
#include <gtest/gtest.h>

#include "core/options.h"
#include "viewer/resolution_control.h"

namespace whit::view {
namespace {

constexpr double kPixels = 1e6;

// As after many frames of `ms` for the whole window.
ResolutionControl learned(double ms, double rate = kDefaultRate) {
  ResolutionControl control(rate, 1);
  for (int i = 0; i < 100; ++i) control.learn(ms, kPixels);
  return control;
}

// What it settles on.
double scaleOf(ResolutionControl& control) {
  for (std::size_t i = 0; i < kScales.size(); ++i) control.moving(kPixels);
  return control.moving(kPixels).scale;
}

TEST(ResolutionControl, BeginsWithAllPixels) {
  ResolutionControl control(kDefaultRate, 3);
  EXPECT_EQ(control.moving(kPixels), (Sharpness{1, 3}));
}

TEST(ResolutionControl, TakesTheFinestScaleThatHoldsTheRate) {
  ResolutionControl slow = learned(100);
  EXPECT_EQ(scaleOf(slow), 0.375);  // 14.1 ms; 0.5 would take 25
  ResolutionControl patient = learned(100, kLeastRate);
  EXPECT_EQ(scaleOf(patient), 0.625);  // 39 ms of 50; 0.75 would take 56
  ResolutionControl fast = learned(10);
  EXPECT_EQ(scaleOf(fast), 1);
  ResolutionControl hopeless = learned(1e6);
  EXPECT_EQ(scaleOf(hopeless), kScales.back());
}

TEST(ResolutionControl, WhatHasToWaitIsCoarser) {
  ResolutionControl control = learned(15);
  EXPECT_EQ(control.moving(kPixels).scale, 1);
  EXPECT_EQ(control.moving(kPixels, 5).scale, 0.875);  // 11.5 ms of the 11.7 that are left
  EXPECT_EQ(control.moving(kPixels, 1000).scale, kScales.back());
}

TEST(ResolutionControl, MoreSamplesCostMore) {
  ResolutionControl control(kDefaultRate, 4);
  control.learn(100, 4 * kPixels);  // four samples a pixel
  EXPECT_EQ(scaleOf(control), 0.375);
}

TEST(ResolutionControl, FewerSamplesWhereTheCoarsestScaleIsNotEnough) {
  ResolutionControl control(kDefaultRate, 64);
  control.learn(1000, kPixels);
  // A 64th of the pixels: 15.6 ms a sample, one of which fits.
  EXPECT_EQ(scaleOf(control), kScales.back());
  EXPECT_EQ(control.moving(kPixels), (Sharpness{kScales.back(), 1}));
  ResolutionControl quicker(kDefaultRate, 64);
  quicker.learn(100, kPixels);  // ten of them fit
  EXPECT_EQ(scaleOf(quicker), kScales.back());
  EXPECT_EQ(quicker.moving(kPixels), (Sharpness{kScales.back(), 10}));
}

TEST(ResolutionControl, DoesNotFlutter) {
  // 15 ms: holds the rate where it is, but is too close to it to be worth going back to.
  ResolutionControl control = learned(15);
  EXPECT_EQ(scaleOf(control), 1);
  for (int i = 0; i < 100; ++i) control.learn(20, kPixels);
  EXPECT_EQ(scaleOf(control), 0.875);
  for (int i = 0; i < 100; ++i) control.learn(15, kPixels);
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

TEST(ResolutionControl, SharpensAtRestStepByStep) {
  ResolutionControl control = learned(100);
  EXPECT_EQ(control.still(), (Sharpness{1, 1}));
  EXPECT_TRUE(control.sharpen());
  EXPECT_EQ(control.still(), (Sharpness{1, 4}));
  EXPECT_TRUE(control.sharpen());
  EXPECT_EQ(control.still(), (Sharpness{1, 16}));
  EXPECT_FALSE(control.sharpen());
  control.restartSharpening();
  EXPECT_EQ(control.still(), (Sharpness{1, 1}));
}

TEST(ResolutionControl, SamplesStayWithinTheirLimit) {
  ResolutionControl control(kDefaultRate, kSppLimit);
  EXPECT_FALSE(control.sharpen());
  EXPECT_EQ(control.still().spp, kSppLimit);
}

TEST(ResolutionControl, LargestScaleHoldsAtRestAndInMotion) {
  ResolutionControl control = learned(1);
  control.stepLargestScale(-2);
  EXPECT_EQ(control.still().scale, 0.75);
  EXPECT_EQ(scaleOf(control), 0.75);
  control.stepLargestScale(-100);
  EXPECT_EQ(control.largestScale(), kScales.back());
  control.stepLargestScale(100);
  EXPECT_EQ(scaleOf(control), 1);
}

}  // namespace
}  // namespace whit::view
