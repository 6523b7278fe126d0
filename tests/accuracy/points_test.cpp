#include "accuracy/points.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "core/option_table.h"
#include "output/digest.h"

namespace whit::accuracy {
namespace {

const EffectSet kMirrored{Effect::lights, Effect::shadows, Effect::mirror};

// The options with these values.
RenderOptions with(const std::map<std::string, std::string>& values) {
  RenderOptions options;
  for (const auto& [name, value] : values) setOption(options, name, value);
  return options;
}

const Point* find(const PointList& list, const std::string& label) {
  for (const Point& point : list.points) {
    if (point.label() == label) return &point;
  }
  return nullptr;
}

// No two points have the same options or the same label.
void expectDistinct(const PointList& list) {
  std::set<std::string> digests, labels;
  for (const Point& point : list.points) {
    digests.insert(digestOf(point.options));
    labels.insert(point.label());
  }
  EXPECT_EQ(digests.size(), list.points.size());
  EXPECT_EQ(labels.size(), list.points.size());
}

TEST(Points, TheBaselineComesFirstAndNothingTwice) {
  const PointList list = makePoints(RenderOptions(), kMirrored, allKnobs());
  EXPECT_EQ(list.points.front().kind, PointKind::baseline);
  EXPECT_EQ(list.points.front().label(), "standard");
  expectDistinct(list);
}

TEST(Points, OneKnobAtATime) {
  const PointList list = makePoints(RenderOptions(), kMirrored, allKnobs());
  const Point* depth = find(list, "depth=2");
  ASSERT_TRUE(depth);

  EXPECT_EQ(digestOf(depth->options), digestOf(with({{"depth", "2"}})));
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
  const PointList list = makePoints(with({{"spp", "4"}}), kMirrored, chooseKnobs({"depth"}));
  EXPECT_EQ(list.points.front().label(), "baseline");
  const Point* depth = find(list, "depth=2");
  ASSERT_TRUE(depth);
  EXPECT_EQ(depth->options.spp, 4);
  EXPECT_TRUE(find(list, "standard")) << "now a preset among others";
}

const EffectSet kSoftAndRough =
    kMirrored.with(Effect::indirect).with(Effect::glossyReflection).with(Effect::softShadows);

// Adds the points towards all transport to a list.
PointList transportPoints(EffectSet effects, PointList list = {}) {
  addTransportPoints(RenderOptions(), effects, knobsTowardsTransport(), list);
  return list;
}

// The points lead from one sample to all transport. Each number of indirect samples comes alone,
// with more samples of a pixel, and with as many samples of lobes and lights as their knobs allow.
TEST(TransportPoints, LeadToAllTransport) {
  const PointList list = transportPoints(
      kSoftAndRough, makePoints(RenderOptions(), kSoftAndRough, knobsTowardsTransport()));
  for (const char* label :
       {"standard", "indirect=1", "indirect=4", "indirect=16", "indirect=64", "spp=16 indirect=16",
        "spp=16 indirect=64", "indirect=4 glossy=4 light-samples=4"}) {
    EXPECT_TRUE(find(list, label)) << label;
  }

  const Point* rough = find(list, "spp=16 indirect=64 glossy=16 light-samples=16");
  ASSERT_TRUE(rough);
  EXPECT_EQ(digestOf(rough->options),
            digestOf(with(
                {{"spp", "16"}, {"glossy", "16"}, {"indirect", "64"}, {"light-samples", "16"}})));
  EXPECT_EQ(rough->kind, PointKind::joint);
  expectDistinct(list);
}

TEST(TransportPoints, HaveNoLobesWhereTheSceneHasNone) {
  const EffectSet effects = kMirrored.with(Effect::indirect);
  const PointList list = transportPoints(effects);

  EXPECT_EQ(list.points.size(), 8u) << "1, 4, 16 and 64, with 1 and 16 samples";
  for (const Point& point : list.points) {
    EXPECT_EQ(point.options.glossy, 0);
    EXPECT_EQ(point.options.lightSamples, 1);
  }
}

TEST(TransportPoints, AreNoneWhereNothingIsLeftOut) {
  EXPECT_TRUE(transportPoints(kMirrored).points.empty());
}

}  // namespace
}  // namespace whit::accuracy
