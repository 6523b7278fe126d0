// How the costs of knobs are measured and reported.
#include <gtest/gtest.h>

#include "viewer/panel.h"

namespace whit::view {
namespace {

// Frames with the other setting take `ratio` of the time, within `spread` of it.
KnobCost costOf(const char* name, double ratio, double spread) {
  KnobCost cost{name, "off", {}, {}, {}, 100};
  cost.timing.ratio = ratio;
  cost.timing.ratioLow = ratio - spread;
  cost.timing.ratioHigh = ratio + spread;
  return cost;
}

TEST(KnobCosts, AreOfOneViewOnly) {
  TracedFrame frame;
  frame.request.options.depth = 8;
  frame.request.options.size = ImageSize{64, 48};
  const FrameRequest measured = frame.request;
  FrameRequest again = measured;
  again.options.depth = 2;  // another setting of the same view
  EXPECT_TRUE(isMeasuredView(measured, again));

  again.edits = 1;
  EXPECT_FALSE(isMeasuredView(measured, again));

  again = measured;
  again.camera.eye.x = 1;
  EXPECT_FALSE(isMeasuredView(measured, again));
}

TEST(KnobCosts, OnlyWhatCanBeToldFromNoiseIsSaidTheLargestFirst) {
  const std::vector<KnobCost> told = significantCosts(
      {costOf("small", 0.97, 0.02), costOf("noise", 0.95, 0.07), costOf("slower", 1.35, 0.07)});
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0].name, "slower");
  EXPECT_EQ(costText(told[0]), "off would be 35 ms slower");
  EXPECT_EQ(costText(told[1]), "off would be 3.0 ms faster");
}

TEST(KnobCosts, LongFramesAreMeasuredSmaller) {
  EXPECT_EQ(measuredSize({1000, 500}, kMeasuredMs / 1e6), (ImageSize{1000, 500}));
  EXPECT_EQ(measuredSize({1000, 500}, 8 * kMeasuredMs / 1e6), (ImageSize{500, 250}));
  EXPECT_EQ(measuredSize({3, 1}, 1e9), (ImageSize{1, 1}));
}

}  // namespace
}  // namespace whit::view
