// What pixels borrow from their neighbours at half rates.
#include "scene/light_shares.h"

#include <gtest/gtest.h>

namespace whit::test {
namespace {

PixelSurface floorPoint(int x, int y, std::uint32_t material = 1) {
  return {material, 0, {static_cast<float>(x), 0, static_cast<float>(y)}, {0, 1, 0}};
}

std::vector<PixelSurface> floorPoints() {
  std::vector<PixelSurface> points;
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 5; ++x) points.push_back(floorPoint(x, y));
  }
  return points;
}

// A floor of 5 x 3 pixels.
struct Floor {
  std::vector<PixelSurface> surfaces = floorPoints();
  LightShares shares{Crop{0, 0, 5, 3}, surfaces};
};

TEST(LightShares, everyNeighbourOfABorrowerLends) {
  EXPECT_TRUE(LightShares::lends(0, 0));
  EXPECT_FALSE(LightShares::lends(1, 0));
  EXPECT_TRUE(LightShares::lends(1, 1));
}

TEST(LightShares, lendersAreNeighboursOnTheSameSurface) {
  Floor floor;
  EXPECT_EQ(floor.shares.lendersOf(2, 1, floorPoint(2, 1)).count, 4);
  EXPECT_EQ(floor.shares.lendersOf(1, 0, floorPoint(1, 0)).count, 3);  // at the border
  EXPECT_EQ(floor.shares.lendersOf(2, 1, floorPoint(2, 1, 7)).count, 0);
  floor.surfaces[2] = floorPoint(2, 0, 7);  // the one above
  const Lenders three = floor.shares.lendersOf(2, 1, floorPoint(2, 1));
  EXPECT_EQ(three.count, 3);
  EXPECT_EQ(three.shares[0], &floor.shares.at(1, 1));
  EXPECT_EQ(three.shares[1], &floor.shares.at(3, 1));
  EXPECT_EQ(three.shares[2], &floor.shares.at(2, 2));
}

TEST(Lenders, visibilityNeedsTwoThatKnowAndNoneThatObjects) {
  LightShare lit, alsoLit, dark, unknown;
  lit.saw(3, true);
  alsoLit.saw(3, true);
  dark.saw(3, false);
  const auto say = [](std::initializer_list<const LightShare*> list) {
    Lenders lenders;
    for (const LightShare* share : list) {
      lenders.shares[static_cast<std::size_t>(lenders.count++)] = share;
    }
    return lenders.visibility(3);
  };
  EXPECT_EQ(say({}), std::nullopt);
  EXPECT_EQ(say({&lit}), std::nullopt);
  EXPECT_EQ(say({&lit, &unknown, &unknown}), std::nullopt);
  EXPECT_EQ(say({&lit, &unknown, &alsoLit}), true);
  EXPECT_EQ(say({&dark, &dark}), false);
  EXPECT_EQ(say({&lit, &alsoLit, &dark}), std::nullopt);
}

TEST(Lenders, lightsBeyondTheSharedOnesAreUnknown) {
  LightShare share;
  share.saw(63, true);
  share.saw(64, true);
  Lenders lenders;
  lenders.shares = {&share, &share};
  lenders.count = 2;
  EXPECT_EQ(lenders.visibility(63), true);
  EXPECT_EQ(lenders.visibility(64), std::nullopt);
  EXPECT_EQ(lenders.visibility(0), std::nullopt);
}

TEST(Lenders, impulsesAreTheMean) {
  LightShare a, b, c;
  a.impulses = Rgb(1, 0, 0.5f);
  b.impulses = Rgb(2, 0, 0.25f);
  c.impulses = Rgb(3, 3, 0);
  Lenders lenders;
  lenders.shares = {&a, &b, &c};
  lenders.count = 1;
  EXPECT_EQ(lenders.impulses(), std::nullopt);
  lenders.count = 3;
  EXPECT_EQ(lenders.impulses(), Rgb(2, 1, 0.25f));
}

}  // namespace
}  // namespace whit::test
