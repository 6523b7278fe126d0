// How many frames the time of a point is taken from.
#include <gtest/gtest.h>

#include "accuracy/timing.h"

namespace whit::accuracy {
namespace {

double costMs(const Rounds& r, double pointMs, double baselineMs) {
  return (r.frames + r.warmUp) * (r.count * pointMs + (r.count + 1) * baselineMs);
}

TEST(Rounds, AreAsManyAsTheBudgetHasRoomFor) {
  const auto framesOf = [](double ms) {
    const Rounds rounds = roundsFor(ms, ms, kFull.pointMs);
    return rounds.count * rounds.frames;
  };
  EXPECT_EQ(framesOf(100), 12);
  EXPECT_EQ(framesOf(300), 6);   // 35 frames with the baseline's would take 10.5 of 8 s
  EXPECT_EQ(framesOf(1000), 3);  // without frames to warm up
  EXPECT_EQ(framesOf(7000), 1);
}

TEST(Rounds, OfOneFrameAtTheLeastAreAllThatMayExceedTheBudget) {
  for (const double budget : {kQuick.pointMs, kFull.pointMs}) {
    for (double pointMs = 0.5; pointMs < 20000; pointMs *= 1.3) {
      for (const double baselineMs : {0.1 * pointMs, pointMs, 10 * pointMs}) {
        const Rounds r = roundsFor(pointMs, baselineMs, budget);
        ASSERT_GE(r.count * r.frames, 1);
        if (r.count * r.frames > 1) {
          EXPECT_LE(costMs(r, pointMs, baselineMs), budget);
        }
      }
    }
  }
}

}  // namespace
}  // namespace whit::accuracy
