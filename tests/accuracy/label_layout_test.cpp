#include "accuracy/label_layout.h"

#include <gtest/gtest.h>

namespace whit::accuracy {
namespace {

constexpr Box kArea{0, 0, 600, 400};

TEST(LabelLayout, ALonePointHasItsLabelToTheRight) {
  const auto placed = placeLabels({{100, 100, 50, 12}}, kArea, 4);
  ASSERT_EQ(placed.size(), 1u);
  EXPECT_TRUE(placed[0].free);
  EXPECT_FALSE(placed[0].leader);
  EXPECT_DOUBLE_EQ(placed[0].box.left, 106);
  EXPECT_DOUBLE_EQ(placed[0].box.top, 94);
}

TEST(LabelLayout, AtTheRightEdgeItGoesToTheLeft) {
  EXPECT_LT(placeLabels({{590, 100, 50, 12}}, kArea, 4)[0].box.right, 590);
}

// Twelve points within a few pixels: no label on another or on a point.
TEST(LabelLayout, NothingOverlapsInACrowd) {
  std::vector<LabelRequest> requests;
  for (int i = 0; i < 12; ++i) requests.push_back({300.0 + i % 3, 200.0 + i / 3 * 2, 60, 13});
  const auto placed = placeLabels(requests, kArea, 4);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    EXPECT_TRUE(placed[i].free);
    for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(placed[i].box.overlaps(placed[k].box));
    for (const LabelRequest& r : requests) {
      EXPECT_FALSE(placed[i].box.overlaps({r.x - 4, r.y - 4, r.x + 4, r.y + 4}));
    }
  }
}

TEST(LabelLayout, WhatIsTakenStaysFree) {
  const Box words{100, 80, 300, 97};
  const auto placed = placeLabels({{90, 90, 50, 16}}, kArea, 4, {words});
  ASSERT_TRUE(placed[0].free);
  EXPECT_FALSE(placed[0].box.overlaps(words));
}

TEST(LabelLayout, WhereThereIsNoPlaceItSaysSo) {
  EXPECT_FALSE(placeLabels({{10, 10, 50, 12}}, {0, 0, 20, 20}, 4)[0].free);
}

}  // namespace
}  // namespace whit::accuracy
