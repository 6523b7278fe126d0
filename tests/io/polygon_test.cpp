#include "io/polygon.h"

#include <gtest/gtest.h>

#include <cmath>

namespace whit {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

// Returns the vector area of all triangles. It equals the polygon's if they cover the polygon once,
// in its orientation.
Vec3d areaOf(const std::vector<Vec3d>& p, const Triangles& triangles) {
  Vec3d sum;
  for (const auto& t : triangles) sum += cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]) * 0.5;
  return sum;
}

double sumOfAreas(const std::vector<Vec3d>& p, const Triangles& triangles) {
  double sum = 0;
  for (const auto& t : triangles) sum += 0.5 * length(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
  return sum;
}

void expectCovered(const std::vector<Vec3d>& p, const Vec3d& area) {
  Triangles triangles;
  EXPECT_TRUE(triangulate(p, triangles));
  EXPECT_EQ(triangles.size(), p.size() - 2);

  // Coordinates are small integers and halves, whose sums are exact. Lengths are square roots.
  constexpr double kRounding = 1e-9;
  EXPECT_LT(length(areaOf(p, triangles) - area), kRounding * length(area));

  // Triangles that overlap or face the other way would make this sum larger.
  EXPECT_NEAR(sumOfAreas(p, triangles), length(area), kRounding * length(area));
}

TEST(Polygon, TriangleStaysItself) {
  Triangles triangles;
  EXPECT_TRUE(triangulate({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, triangles));
  EXPECT_EQ(triangles, (Triangles{{0, 1, 2}}));
}

TEST(Polygon, ConvexQuadIsCutAlongItsShorterDiagonal) {
  Triangles triangles;
  EXPECT_TRUE(triangulate({{0, 0, 0}, {4, 1, 0}, {5, 5, 0}, {1, 4, 0}}, triangles));
  EXPECT_EQ(triangles, (Triangles{{1, 2, 3}, {1, 3, 0}}));
}

TEST(Polygon, ConcaveQuadIsCutFromItsReflexCorner) {
  // Each corner in turn is the notch of the dart.
  const std::vector<Vec3d> dart{{0, 0, 0}, {2, -2, 0}, {0, 4, 0}, {-2, -2, 0}};
  for (std::size_t turned = 0; turned < 4; ++turned) {
    std::vector<Vec3d> p;
    for (std::size_t i = 0; i < 4; ++i) p.push_back(dart[(i + turned) % 4]);
    expectCovered(p, {0, 0, 8});
  }
}

TEST(Polygon, ConcavePolygonsFarFromTheOriginInAnyPlane) {
  // The outlines are an L and a U of unit squares.
  const std::vector<std::vector<Vec2f>> outlines{
      {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
      {{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}};
  const double areas[] = {3, 5};
  for (std::size_t k = 0; k < outlines.size(); ++k) {
    for (const double far : {0.0, -1000.0, 5000.0}) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const bool reversed : {false, true}) {
          std::vector<Vec3d> p;
          for (const Vec2f& o : outlines[k]) {
            Vec3d corner(far);
            corner[(axis + 1) % 3] += o.x;
            corner[(axis + 2) % 3] += o.y;
            p.push_back(corner);
          }

          if (reversed) p = {p.rbegin(), p.rend()};
          Vec3d area;
          area[axis] = reversed ? -areas[k] : areas[k];
          expectCovered(p, area);
        }
      }
    }
  }
}

TEST(Polygon, CornersOnALineAreKept) {
  expectCovered({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}}, {0, 0, 4});
}

// The corners lay on the sides of a simple polygon and were rounded to integers, so that two sides
// cross within a sliver.
TEST(Polygon, RoundedCornersAreNoCrossing) {
  Triangles triangles;
  EXPECT_TRUE(triangulate({{20, 312, 0},
                           {9, 438, 0},
                           {-59, 218, 0},
                           {-23, 49, 0},
                           {14, -119, 0},
                           {13, -115, 0},
                           {13, -110, 0},
                           {17, 101, 0}},
                          triangles));
}

TEST(Polygon, HoleReachedByASeam) {
  // The square of side 4 has a square hole of side 2, which a seam joins to the outline. The seam
  // is traversed twice.
  expectCovered({{0, 0, 0},
                 {4, 0, 0},
                 {4, 4, 0},
                 {0, 4, 0},
                 {0, 0, 0},
                 {1, 1, 0},
                 {1, 3, 0},
                 {3, 3, 0},
                 {3, 1, 0},
                 {1, 1, 0}},
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
  const Vec3d nan(std::nan(""));
  for (const std::vector<Vec3d>& p :
       {std::vector<Vec3d>(5, {1, 1, 1}), std::vector<Vec3d>(5, nan),
        // Five corners on a line have no area.
        std::vector<Vec3d>{{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {3, 3, 0}, {4, 4, 0}},
        // A five-pointed star drawn in one stroke, and a bow tie with a corner in one of its sides.
        std::vector<Vec3d>{{0, 3, 0}, {2, -3, 0}, {-3, 1, 0}, {3, 1, 0}, {-2, -3, 0}},
        std::vector<Vec3d>{{0, 0, 0}, {2, 2, 0}, {2, 1, 0}, {2, 0, 0}, {0, 1, 0}}}) {
    Triangles triangles;
    EXPECT_FALSE(triangulate(p, triangles));
    EXPECT_EQ(triangles.size(), 3u);
  }
}

}  // namespace
}  // namespace whit
