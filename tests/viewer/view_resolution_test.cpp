// The scale that holds a frame rate. A frame may take 1000 / 60 = 16.7 ms unless a test has another
// rate.
#include <gtest/gtest.h>

#include <vector>

#include "core/options.h"
#include "viewer/session/resolution_control.h"

namespace whit::view {
namespace {

constexpr double kPixels = 1e6;

void learn(ResolutionControl& control, double ms, bool plain = false) {
  for (int i = 0; i < 100; ++i) control.learn(ms, kPixels, plain);
}

// Returns a control that has seen many frames of `ms` for the whole window.
ResolutionControl learned(double ms, double rate = kDefaultRate, int spp = 1) {
  ResolutionControl control(rate, spp);
  learn(control, ms);
  return control;
}

// Returns what the control stays at in motion.
Sharpness chosen(ResolutionControl& control) {
  for (std::size_t i = 0; i < 2 * kScales.size(); ++i) control.moving(kPixels);
  return control.moving(kPixels);
}
// The same after many frames of `ms`.
Sharpness chosenAfter(double ms, ResolutionControl& control, bool plain = false) {
  learn(control, ms, plain);
  return chosen(control);
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

// What controls of a rate and a number of samples choose after frames of one length after another.
struct Course {
  double rate;
  int spp;
  std::vector<std::pair<double, Sharpness>> chosenAfterMs;
};

TEST(ResolutionControl, ChoosesWhatHoldsTheRate) {
  const Course courses[] = {
      {kDefaultRate,
       1,
       {{100, {0.375, 1}},  // 14.1 ms; 0.4375 would take 19
        {10, {1, 1}},
        {1e6, {kScales.back(), 1}}}},
      {kLeastRate, 1, {{100, {0.6875, 1}}}},  // 47 ms of 50; 0.75 would take 56
      // Samples go before resolution.
      {kDefaultRate,
       16,
       {{0.5, {1, 16}},
        {3, {1, 4}},  // 12 ms; 8 would take 24
        {16, {1, 1}},
        {100, {0.375, 1}}}},
      // The scale does not flutter: 0.9375 would take 15.8 ms in the third case. It would hold the
      // rate, but so barely that the control does not return to it.
      {kDefaultRate, 1, {{15.5, {1, 1}}, {20, {0.875, 1}}, {18, {0.875, 1}}, {10, {1, 1}}}},
  };
  for (const Course& course : courses) {
    ResolutionControl control(course.rate, course.spp);
    for (const auto& [ms, sharpness] : course.chosenAfterMs) {
      EXPECT_EQ(chosenAfter(ms, control), sharpness) << ms << " ms of " << course.spp;
    }
  }
}

// Returns a control of sampled rays that has seen a frame with plain ones.
ResolutionControl sampling(double plainMs) {
  ResolutionControl control(kDefaultRate, 1);
  control.setSamples(1, true);
  control.learn(plainMs, kPixels, true);
  return control;
}

// A sample costs 30 ms with sampled rays, of which plain ones take a tenth.
TEST(ResolutionControl, SampledRaysGoBeforeResolution) {
  ResolutionControl control = sampling(3);
  learn(control, 30);
  for (int i = 0; i < 3; ++i) control.moving(kPixels);
  EXPECT_EQ(control.moving(kPixels), (Sharpness{1, 1, true}));

  // They come back where there is time for them, and resolution goes after they have gone.
  learn(control, 1, true);
  EXPECT_EQ(control.moving(kPixels), (Sharpness{1, 1, false}));
  learn(control, 100, true);
  EXPECT_EQ(control.moving(kPixels), (Sharpness{0.375, 1, true}));
}

// Until a sample with them was traced, they are only tried where they seem to be affordable.
TEST(ResolutionControl, SampledRaysAreExpectedToCostMore) {
  EXPECT_TRUE(sampling(8).moving(kPixels).plain);
  EXPECT_FALSE(sampling(2).moving(kPixels).plain);
}

TEST(ResolutionControl, RatesStayWithinLimits) {
  EXPECT_EQ(ResolutionControl(1, 1).rate(), kLeastRate);
  EXPECT_EQ(ResolutionControl(1e9, 1).rate(), kLargestRate);
}

TEST(ResolutionControl, IgnoresFramesWithoutTime) {
  ResolutionControl control = learned(10);
  control.learn(0, kPixels);
  control.learn(10, 0);
  EXPECT_EQ(chosen(control).scale, 1);
}

using Steps = std::vector<Sharpness>;

// Returns the steps of a picture at rest, which begins with nothing or with a picture of
// `shownScale`.
Steps stepsAtRest(ResolutionControl& control, bool supersample, double shownScale = 0) {
  control.startSharpening(kPixels, shownScale);
  Steps steps{control.still(supersample)};
  while (control.sharpen(supersample)) steps.push_back(control.still(supersample));
  return steps;
}

Steps stepsAtRest(ResolutionControl&& control, bool supersample, double shownScale = 0) {
  return stepsAtRest(control, supersample, shownScale);
}

TEST(ResolutionControl, SharpensAtRestStepByStep) {
  // A slow machine begins coarse and with one sample, and each step has four times the pixels.
  Steps slow{{0.125, 1}, {0.25, 1}, {0.5, 1}, {1, 1}};
  EXPECT_EQ(stepsAtRest(learned(1e5), false), slow);
  slow.push_back({1, 4});
  EXPECT_EQ(stepsAtRest(learned(1e5, kDefaultRate, 4), false), slow);
  slow.push_back({1, 16});
  EXPECT_EQ(stepsAtRest(learned(1e5), true), slow);

  EXPECT_EQ(stepsAtRest(learned(150), false), (Steps{{0.5, 1}, {1, 1}}));  // 37 ms for a half
  EXPECT_EQ(stepsAtRest(learned(10), true), (Steps{{1, 1}, {1, 4}, {1, 16}}));
}

TEST(ResolutionControl, WhatIsShownGetsNoCoarser) {
  for (const auto& [shown, first] : {std::pair{0.25, 0.25}, {0.375, 0.5}, {1.0, 1.0}}) {
    EXPECT_EQ(stepsAtRest(learned(1e5), false, shown).front().scale, first) << shown;
  }
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
  EXPECT_EQ(stepsAtRest(ResolutionControl(kDefaultRate, kSppLimit), true).back(),
            (Sharpness{1, kSppLimit}));
}

}  // namespace
}  // namespace whit::view
