#include "accuracy/sweep.h"

#include <gtest/gtest.h>

#include <set>

#include "accuracy/digest.h"

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
  const PointList list = makePoints(RenderOptions(), kMirrored, allKnobs(), 40, 1);
  EXPECT_EQ(list.points.front().kind, PointKind::baseline);
  EXPECT_EQ(list.points.front().label(), "standard");
  std::set<std::string> digests;
  for (const Point& point : list.points) digests.insert(digestOf(point.options));
  EXPECT_EQ(digests.size(), list.points.size());
}

TEST(Points, OneKnobAtATime) {
  const PointList list = makePoints(RenderOptions(), kMirrored, allKnobs(), 0, 1);
  const Point* depth = find(list, "depth=2");
  ASSERT_TRUE(depth);
  RenderOptions expected;
  expected.depth = 2;
  EXPECT_EQ(digestOf(depth->options), digestOf(expected));
  EXPECT_EQ(depth->cause, Cause::algorithm);
  EXPECT_FALSE(find(list, "depth=64")) << "the default is the baseline";
  EXPECT_TRUE(find(list, "draft"));
}

TEST(Points, WhatDoesNothingIsLeftOutWithTheReason) {
  const PointList list = makePoints(RenderOptions(), EffectSet(), chooseKnobs({"depth"}), 0, 1);
  EXPECT_FALSE(find(list, "depth=2"));
  ASSERT_EQ(list.idle.size(), 1u);
  EXPECT_EQ(list.idle[0].name, "depth");
  EXPECT_EQ(list.idle[0].because, "nothing in the scene reflects or refracts");
}

TEST(Points, OptionsOfTheCommandLineAreTheBaseline) {
  RenderOptions base;
  base.spp = 4;
  const PointList list = makePoints(base, kMirrored, chooseKnobs({"depth"}), 0, 1);
  EXPECT_EQ(list.points.front().label(), "baseline");
  ASSERT_TRUE(find(list, "depth=2"));
  EXPECT_EQ(find(list, "depth=2")->options.spp, 4);
  EXPECT_TRUE(find(list, "standard")) << "now a preset among others";
}

TEST(Points, CombinationsAreLimitedAndRepeatable) {
  const auto labels = [](std::uint32_t seed) {
    std::vector<std::string> all;
    for (const Point& p : makePoints(RenderOptions(), kMirrored, allKnobs(), 10, seed).points) {
      if (p.kind == PointKind::joint) all.push_back(p.label());
    }
    return all;
  };
  EXPECT_EQ(labels(1).size(), 10u);
  for (const std::string& label : labels(1))
    EXPECT_EQ(label.find("depth=64"), std::string::npos) << label << ": the default";
  EXPECT_EQ(labels(1), labels(1));
  EXPECT_NE(labels(1), labels(2));
}

}  // namespace
}  // namespace whit::accuracy
