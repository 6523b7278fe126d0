// The front against its definition, by brute force and by hand.
#include "accuracy/pareto.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace whit::accuracy {
namespace {

using Indices = std::vector<std::size_t>;

TEST(Pareto, ByHand) {
  EXPECT_EQ(paretoFront({}), Indices{});
  EXPECT_EQ(paretoFront({{3, 1}}), Indices{0});
  // The second is beaten by the first in both; the third is dearer but better.
  EXPECT_EQ(paretoFront({{1, 5}, {2, 6}, {4, 1}}), (Indices{0, 2}));
  // Equal cost: the better one. Equal error: the cheaper one. Equal in both: the first.
  EXPECT_EQ(paretoFront({{1, 5}, {1, 4}}), Indices{1});
  EXPECT_EQ(paretoFront({{2, 4}, {1, 4}}), Indices{1});
  EXPECT_EQ(paretoFront({{1, 4}, {1, 4}}), Indices{0});
}

TEST(Pareto, NotFiniteIsNeverOnTheFront) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  EXPECT_EQ(paretoFront({{1, nan}, {nan, 1}, {-inf, 0}, {2, 3}, {1, inf}}), Indices{3});
}

TEST(Pareto, AgainstTheDefinition) {
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    std::vector<CostAndError> points(1 + random() % 12);
    for (CostAndError& p : points) p = {double(random() % 6), double(random() % 6)};
    const Indices front = paretoFront(points);
    const std::set<std::size_t> members(front.begin(), front.end());
    std::set<std::pair<double, double>> values;
    for (std::size_t i = 0; i < points.size(); ++i) {
      bool beaten = false;
      for (const CostAndError& q : points) {
        const CostAndError& p = points[i];
        beaten |= q.cost <= p.cost && q.error <= p.error && (q.cost < p.cost || q.error < p.error);
      }
      EXPECT_FALSE(beaten && members.contains(i));
      if (!beaten) values.insert({points[i].cost, points[i].error});
    }
    EXPECT_EQ(front.size(), values.size()) << "each value once";
  }
}

}  // namespace
}  // namespace whit::accuracy
