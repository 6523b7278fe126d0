#include "io/polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace whit {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

void expectCovered(const std::vector<Vec3d>& p, const Vec3d& area) {
  Triangles triangles;
  EXPECT_TRUE(triangulate(p, triangles));
  EXPECT_EQ(triangles.size(), p.size() - 2);

  // The vector areas of all triangles add up to the polygon's if they cover it once, in its
  // orientation. Triangles that overlap or face the other way would make the sum of sizes larger.
  Vec3d sum;
  double sumOfSizes = 0;
  for (const auto& t : triangles) {
    const Vec3d own = cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]) * 0.5;
    sum += own;
    sumOfSizes += length(own);
  }

  // Coordinates are small integers and halves, whose sums are exact. Lengths are square roots.
  constexpr double kRounding = 1e-9;
  EXPECT_LT(length(sum - area), kRounding * length(area));
  EXPECT_NEAR(sumOfSizes, length(area), kRounding * length(area));
}

// Returns a polygon in a plane that crosses an axis at `far`.
std::vector<Vec3d> polygon(const std::vector<Vec2f>& outline, int axis = 2, double far = 0) {
  std::vector<Vec3d> corners;
  for (const Vec2f& o : outline) {
    Vec3d& corner = corners.emplace_back(far);
    corner[(axis + 1) % 3] += o.x;
    corner[(axis + 2) % 3] += o.y;
  }
  return corners;
}

TEST(Polygon, TriangleStaysItself) {
  Triangles triangles;
  EXPECT_TRUE(triangulate(polygon({{0, 0}, {1, 0}, {0, 1}}), triangles));
  EXPECT_EQ(triangles, (Triangles{{0, 1, 2}}));
}

TEST(Polygon, ConvexQuadIsCutAlongItsShorterDiagonal) {
  Triangles triangles;
  EXPECT_TRUE(triangulate(polygon({{0, 0}, {4, 1}, {5, 5}, {1, 4}}), triangles));
  EXPECT_EQ(triangles, (Triangles{{1, 2, 3}, {1, 3, 0}}));
}

TEST(Polygon, ConcaveQuadIsCutFromItsReflexCorner) {
  // Each corner in turn is the notch of the dart.
  std::vector<Vec3d> dart = polygon({{0, 0}, {2, -2}, {0, 4}, {-2, -2}});
  for (int turned = 0; turned < 4; ++turned) {
    expectCovered(dart, {0, 0, 8});
    std::rotate(dart.begin(), dart.begin() + 1, dart.end());
  }
}

TEST(Polygon, ConcavePolygonsFarFromTheOriginInAnyPlane) {
  // The outlines are an L and a U of unit squares.
  const std::pair<std::vector<Vec2f>, double> outlines[] = {
      {{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 3},
      {{{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 5}};
  for (const auto& [outline, size] : outlines) {
    for (const double far : {0.0, -1000.0, 5000.0}) {
      for (int axis = 0; axis < 3; ++axis) {
        std::vector<Vec3d> p = polygon(outline, axis, far);
        Vec3d area;
        area[axis] = size;
        expectCovered(p, area);
        std::ranges::reverse(p);
        expectCovered(p, -area);
      }
    }
  }
}

TEST(Polygon, CornersOnALineAreKept) {
  expectCovered(polygon({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}}), {0, 0, 4});
}

// The corners lay on the sides of a simple polygon and were rounded to integers, so that two sides
// cross within a sliver.
TEST(Polygon, RoundedCornersAreNoCrossing) {
  Triangles triangles;
  EXPECT_TRUE(triangulate(polygon({{20, 312},
                                   {9, 438},
                                   {-59, 218},
                                   {-23, 49},
                                   {14, -119},
                                   {13, -115},
                                   {13, -110},
                                   {17, 101}}),
                          triangles));
}

TEST(Polygon, HoleReachedByASeam) {
  // The square of side 4 has a square hole of side 2, which a seam joins to the outline. The seam
  // is traversed twice.
  expectCovered(
      polygon({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}}),
      {0, 0, 12});
}

TEST(Polygon, ManyCornersOnACircle) {
  for (const std::size_t count : {std::size_t{100}, kEarCornerLimit + 1}) {
    std::vector<Vec3d> p;
    for (std::size_t i = 0; i < count; ++i) {
      const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(count);
      p.push_back({std::cos(angle), 0, -std::sin(angle)});
    }

    const double n = static_cast<double>(count);
    expectCovered(p, {0, 0.5 * n * std::sin(2 * M_PI / n), 0});
  }
}

TEST(Polygon, WhatHasNoOutlineBecomesAFan) {
  const Vec3d nan(NAN);
  for (const std::vector<Vec3d>& p :
       {std::vector<Vec3d>(5, {1, 1, 1}), std::vector<Vec3d>(5, nan),
        // Five corners on a line have no area.
        polygon({{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}}),
        // A five-pointed star drawn in one stroke, and a bow tie with a corner in one of its sides.
        polygon({{0, 3}, {2, -3}, {-3, 1}, {3, 1}, {-2, -3}}),
        polygon({{0, 0}, {2, 2}, {2, 1}, {2, 0}, {0, 1}})}) {
    Triangles triangles;
    EXPECT_FALSE(triangulate(p, triangles));
    EXPECT_EQ(triangles.size(), 3u);
  }
}

}  // namespace
}  // namespace whit
