// Which frames are compared to tell what a knob costs.
#include <gtest/gtest.h>

#include "viewer/knob_costs.h"

namespace whit::view {
namespace {

// At rest, as many samples as asked for.
TracedFrame frameOf(const RenderOptions& options, double ms) {
  TracedFrame frame;
  frame.request.options = options;
  frame.request.options.size = ImageSize{64, 48};
  frame.request.spp = options.spp;
  frame.request.interruptible = true;
  frame.stats.frameMs = ms;
  return frame;
}

RenderOptions withDepth(int depth) {
  RenderOptions options;
  options.depth = depth;
  return options;
}

TEST(KnobCosts, TellsBeforeFromAfter) {
  KnobCosts costs;
  costs.learn(frameOf(withDepth(8), 20));
  EXPECT_EQ(costs.lastChanged(), "");
  costs.learn(frameOf(withDepth(2), 12));
  ASSERT_EQ(costs.lastChanged(), "depth");
  const KnobChange change = costs.changes().at("depth");
  EXPECT_EQ(change.from, "8");
  EXPECT_EQ(change.to, "2");
  EXPECT_EQ(change.before.frameMs, 20);
  EXPECT_EQ(change.after.frameMs, 12);
}

TEST(KnobCosts, EffectsAndSeveralAtOnce) {
  KnobCosts costs;
  RenderOptions options = withDepth(8);
  costs.learn(frameOf(options, 20));
  options.disable = options.disable.with(Effect::mirror);
  costs.learn(frameOf(options, 15));
  EXPECT_EQ(costs.changes().at("disable").from, "none");
  EXPECT_EQ(costs.changes().at("disable").to, "mirror");
  options.depth = 3;
  options.robust = false;
  costs.learn(frameOf(options, 10));
  EXPECT_EQ(costs.lastChanged(), "depth, robust");
  EXPECT_EQ(costs.changes().at("depth, robust").to, "3, off");
}

TEST(KnobCosts, OnlyLikeFramesAreCompared) {
  KnobCosts costs;
  costs.learn(frameOf(withDepth(8), 20));
  TracedFrame moving = frameOf(withDepth(2), 12);
  moving.request.interruptible = false;
  costs.learn(moving);
  TracedFrame sharper = frameOf(withDepth(2), 12);
  sharper.request.spp = 16;
  costs.learn(sharper);
  TracedFrame elsewhere = frameOf(withDepth(2), 12);
  elsewhere.request.camera.eye.x = 1;
  costs.learn(elsewhere);
  TracedFrame larger = frameOf(withDepth(3), 12);
  larger.request.options.size = ImageSize{128, 96};
  larger.request.camera.eye.x = 1;
  costs.learn(larger);
  TracedFrame edited = larger;
  edited.request.options.depth = 4;
  edited.request.edits = 1;
  costs.learn(edited);
  EXPECT_EQ(costs.lastChanged(), "");
  EXPECT_TRUE(costs.changes().empty());
}

TEST(KnobCosts, WhatWasMeasuredIsOfOneViewOnly) {
  KnobCosts costs;
  TracedFrame frame = frameOf(withDepth(8), 20);
  frame.costs = {{"depth", "0", frame.stats, frame.stats}};
  costs.learn(frame);
  EXPECT_NE(costs.measured("depth"), nullptr);
  TracedFrame again = frameOf(withDepth(2), 12);  // another setting of the same view
  costs.learn(again);
  EXPECT_NE(costs.measured("depth"), nullptr);
  again.request.camera.eye.x = 1;
  costs.learn(again);
  EXPECT_EQ(costs.measured("depth"), nullptr);
}

KnobCost costOf(const char* name, double now, double then, double spread) {
  KnobCost cost{name, "off", {}, {}, spread};
  cost.now.frameMs = now;
  cost.then.frameMs = then;
  return cost;
}

TEST(KnobCosts, OnlyWhatCanBeToldFromNoiseIsSaidTheLargestFirst) {
  const std::vector<KnobCost> told = toldFromNoise(
      {costOf("small", 100, 97, 2), costOf("noise", 100, 95, 7), costOf("slower", 100, 135, 7)});
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0].name, "slower");
  EXPECT_EQ(costText(told[0]), "off would be 35 ms slower");
  EXPECT_EQ(costText(told[1]), "off would be 3.0 ms faster");
}

TEST(KnobCosts, WhatIsMeasuredSoFarCounts) {
  KnobCosts costs;
  UnfinishedFrame sofar;
  sofar.request = frameOf(withDepth(8), 20).request;
  sofar.request.measureKnobs = true;
  sofar.costs = {costOf("mirror", 20, 12, 1)};
  costs.learn(sofar);
  EXPECT_NE(costs.measured("mirror"), nullptr);
  costs.learn(frameOf(withDepth(8), 20));
  EXPECT_NE(costs.measured("mirror"), nullptr) << "the same view";
}

TEST(KnobCosts, LongFramesAreMeasuredSmaller) {
  EXPECT_EQ(measuredSize({1000, 500}, kMeasuredMs / 1e6), (ImageSize{1000, 500}));
  EXPECT_EQ(measuredSize({1000, 500}, 8 * kMeasuredMs / 1e6), (ImageSize{500, 250}));
  EXPECT_EQ(measuredSize({3, 1}, 1e9), (ImageSize{1, 1}));
}

}  // namespace
}  // namespace whit::view
