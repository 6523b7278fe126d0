#include "accuracy/points.h"

#include <gtest/gtest.h>

#include <set>

#include "output/digest.h"

namespace whit::accuracy {
namespace {

const EffectSet kMirrored =
    EffectSet().with(Effect::lights).with(Effect::shadows).with(Effect::mirror);

const Point* find(const PointList& list, const std::string& label) {
  for (const Point& point : list.points) {
    if (point.label() == label) return &point;
  }
  return nullptr;
}

TEST(Points, TheBaselineComesFirstAndNothingTwice) {
  const PointList list = makePoints(RenderOptions(), kMirrored, allKnobs());
  EXPECT_EQ(list.points.front().kind, PointKind::baseline);
  EXPECT_EQ(list.points.front().label(), "standard");
  std::set<std::string> digests;
  for (const Point& point : list.points) digests.insert(digestOf(point.options));
  EXPECT_EQ(digests.size(), list.points.size());
}

TEST(Points, OneKnobAtATime) {
  const PointList list = makePoints(RenderOptions(), kMirrored, allKnobs());
  const Point* depth = find(list, "depth=2");
  ASSERT_TRUE(depth);

  RenderOptions expected;
  expected.depth = 2;
  EXPECT_EQ(digestOf(depth->options), digestOf(expected));
  EXPECT_EQ(depth->cause, Cause::algorithm);
  EXPECT_FALSE(find(list, "depth=64")) << "the default is the baseline";
  EXPECT_TRUE(find(list, "good"));
}

TEST(Points, WhatDoesNothingIsLeftOutWithTheReason) {
  const PointList list = makePoints(RenderOptions(), EffectSet(), chooseKnobs({"depth"}));
  EXPECT_FALSE(find(list, "depth=2"));
  ASSERT_EQ(list.idle.size(), 1u);
  EXPECT_EQ(list.idle[0].name, "depth");
  EXPECT_EQ(list.idle[0].because, "not among the effects of the scene: mirror,transmission");
}

TEST(Points, OptionsOfTheCommandLineAreTheBaseline) {
  RenderOptions base;
  base.spp = 4;
  const PointList list = makePoints(base, kMirrored, chooseKnobs({"depth"}));
  EXPECT_EQ(list.points.front().label(), "baseline");
  ASSERT_TRUE(find(list, "depth=2"));
  EXPECT_EQ(find(list, "depth=2")->options.spp, 4);
  EXPECT_TRUE(find(list, "standard")) << "now a preset among others";
}

const EffectSet kSoftAndRough =
    kMirrored.with(Effect::indirect).with(Effect::glossyReflection).with(Effect::softShadows);

// The points lead from one sample to all transport. Each number of indirect samples comes alone,
// with more samples of a pixel, and with as many samples of lobes and lights as their knobs allow.
TEST(TransportPoints, LeadToAllTransport) {
  PointList list = makePoints(RenderOptions(), kSoftAndRough, knobsTowardsTransport());
  addTransportPoints(RenderOptions(), kSoftAndRough, knobsTowardsTransport(), list);
  for (const char* label :
       {"standard", "indirect=1", "indirect=4", "indirect=16", "indirect=64", "spp=16 indirect=16",
        "spp=16 indirect=64", "indirect=4 glossy=4 light-samples=4",
        "spp=16 indirect=64 glossy=16 light-samples=16"}) {
    EXPECT_TRUE(find(list, label)) << label;
  }

  const Point* rough = find(list, "spp=16 indirect=64 glossy=16 light-samples=16");
  ASSERT_TRUE(rough);
  EXPECT_EQ(rough->options.spp, 16);
  EXPECT_EQ(rough->options.indirect, 64);
  EXPECT_EQ(rough->options.glossy, 16);
  EXPECT_EQ(rough->options.lightSamples, 16);
  EXPECT_EQ(rough->kind, PointKind::joint);

  // No two points have the same options or the same label.
  std::set<std::string> digests, labels;
  for (const Point& point : list.points) {
    digests.insert(digestOf(point.options));
    labels.insert(point.label());
  }
  EXPECT_EQ(digests.size(), list.points.size());
  EXPECT_EQ(labels.size(), list.points.size());
}

TEST(TransportPoints, HaveNoLobesWhereTheSceneHasNone) {
  const EffectSet effects = kMirrored.with(Effect::indirect);
  PointList list;
  addTransportPoints(RenderOptions(), effects, knobsTowardsTransport(), list);

  EXPECT_EQ(list.points.size(), 8u) << "1, 4, 16 and 64, with 1 and 16 samples";
  for (const Point& point : list.points) {
    EXPECT_EQ(point.options.glossy, 0);
    EXPECT_EQ(point.options.lightSamples, 1);
  }
}

TEST(TransportPoints, AreNoneWhereNothingIsLeftOut) {
  PointList list;
  addTransportPoints(RenderOptions(), kMirrored, knobsTowardsTransport(), list);
  EXPECT_TRUE(list.points.empty());
}

}  // namespace
}  // namespace whit::accuracy
