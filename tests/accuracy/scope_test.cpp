// How many samples the references of a sweep have, and which points and comparisons it leaves out.
#include <gtest/gtest.h>

#include "accuracy/sweep.h"

namespace whit::accuracy {
namespace {

Scope quick(double frameRays, double raysPerSample) {
  return {kQuick, frameRays, raysPerSample, false, 1, 0};
}

Point arithmeticPoint() {
  Point point;
  point.knob = "robust";
  point.value = "off";
  point.cause = Cause::arithmetic;
  return point;
}

TEST(Scope, TheReferenceHasAsManySamplesAsItsRaysAllow) {
  EXPECT_EQ(quick(1e5, 1e5).samples(), 64);  // takes 6.4 of 30 million rays
  EXPECT_EQ(quick(1e6, 1e6).samples(), 16);  // 32 samples would take 32 million
  EXPECT_EQ(quick(1e6, 30e6).samples(), 2);  // never fewer
  EXPECT_EQ((Scope{kFull, 1e6, 1e6, false, 1, 0}).samples(), 256);
}

// On a machine where a sample takes a second, 64 of them would leave no time for any point.
TEST(Scope, TheReferenceTakesAThirdOfTheBudgetAtMost) {
  Scope slow = quick(1e5, 1e5);
  slow.msPerSample = 1000;
  slow.mostMs = referenceMs(20);
  EXPECT_EQ(slow.samples(), 4);  // 8 samples would take 8 of 6.7 seconds
  slow.mostMs = referenceMs(60);
  EXPECT_EQ(slow.samples(), 16);
  EXPECT_EQ(referenceMs(0), referenceMs(20)) << "without timing, errors are measured as well";
  slow.msPerSample = 1e6;
  EXPECT_EQ(slow.samples(), 2) << "never fewer";
}

// The 8 passes may trace 400 million rays in all.
TEST(Scope, APassHasAsManySamplesAsItsRaysAllow) {
  EXPECT_EQ(quick(1e5, 1e5).transportSamples(7e5), 64);  // 358 million
  EXPECT_EQ(quick(1e5, 1e5).transportSamples(8e5), 32);
  EXPECT_EQ(quick(1e5, 1e5).transportSamples(1e9), 1);  // never fewer
  EXPECT_EQ(quick(1e6, 1e6).transportSamples(1e5), 16) << "no more than the reference has";
}

TEST(Scope, LeavesOutWhatTheReferenceCannotJudge) {
  Point point;
  point.knob = "spp";
  point.options.spp = 8;
  EXPECT_EQ(quick(1e6, 1e6).leavesOut(point), "");
  EXPECT_NE(quick(2e6, 2e6).leavesOut(point), "") << "8 of 8 samples";
  point.kind = PointKind::baseline;
  EXPECT_EQ(quick(2e6, 2e6).leavesOut(point), "");
}

TEST(Scope, LeavesOutLongPicturesOfTheScalarReference) {
  Point point = arithmeticPoint();
  point.options.mode = Mode::reference;
  EXPECT_EQ(quick(1e6, 20e6).leavesOut(point), "");
  EXPECT_NE(quick(1e6, 21e6).leavesOut(point), "");
}

TEST(Scope, ComparesPathsOfTheBaselineAloneWhereFramesAreLong) {
  Point baseline;
  baseline.kind = PointKind::baseline;
  for (const double rays : {1e6, 6e6}) {
    EXPECT_TRUE(quick(rays, rays).comparesPaths(baseline));
    EXPECT_EQ(quick(rays, rays).comparesPaths(arithmeticPoint()), rays < 2e6);
  }

  Scope chosen = quick(6e6, 6e6);
  chosen.chosenKnobs = true;
  EXPECT_TRUE(chosen.comparesPaths(arithmeticPoint()));
}

TEST(Scope, AQuickSweepIsOverUnlessItsKnobsWereChosen) {
  Scope scope = quick(1e6, 1e6);
  EXPECT_FALSE(scope.isOver(kQuick.seconds));
  EXPECT_TRUE(scope.isOver(kQuick.seconds + 1));
  EXPECT_LT(kQuick.seconds + kQuick.timingSeconds + referenceMs(kQuick.timingSeconds) / 1000, 60)
      << "the last point and the report come after that";
  scope.chosenKnobs = true;
  EXPECT_FALSE(scope.isOver(1e6));
}

}  // namespace
}  // namespace whit::accuracy
