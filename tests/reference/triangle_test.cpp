// Rays against triangles in double precision, one by one and by brute force.
#include "surfaces/intersect.h"

#include <gtest/gtest.h>

#include "reference/small_scenes.h"

namespace whit::reference {
namespace {

using test::Numbers;
using test::SceneBuilder;

const Corners kUnit{Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}};

TEST(Triangle, HitHasDistanceAndWeights) {
  const auto hit = intersectTriangle({{0.25, 0.5, 3}, {0, 0, -2}}, kUnit);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->t, 1.5);  // in lengths of the direction
  EXPECT_EQ(hit->u, 0.25);
  EXPECT_EQ(hit->v, 0.5);
}

TEST(Triangle, BothSidesAreHit) {
  const auto hit = intersectTriangle({{0.25, 0.5, -1}, {0, 0, 1}}, kUnit);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->u, 0.25);
}

TEST(Triangle, MissesBesideAndBehind) {
  EXPECT_FALSE(intersectTriangle({{0.75, 0.5, 1}, {0, 0, -1}}, kUnit));
  EXPECT_FALSE(intersectTriangle({{-0.01, 0.5, 1}, {0, 0, -1}}, kUnit));
  EXPECT_FALSE(intersectTriangle({{0.25, 0.25, 1}, {0, 0, 1}}, kUnit));
  EXPECT_FALSE(intersectTriangle({{0.25, 0.25, 0}, {0, 0, 1}}, kUnit)) << "t = 0 is no hit";
}

// Hard case H21: a ray in the plane of the triangle.
TEST(Triangle, RayInThePlaneMisses) {
  EXPECT_FALSE(intersectTriangle({{-1, 0.25, 0}, {1, 0, 0}}, kUnit));
  EXPECT_FALSE(intersectTriangle({{0.25, 0.25, 0}, {1, 0, 0}}, kUnit));
}

TEST(Triangle, WithoutAreaOrDirectionMisses) {
  const Corners line{Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{2, 0, 0}};
  EXPECT_FALSE(piercePlane({{0.5, 0, 1}, {0, 0, -1}}, line));
  EXPECT_FALSE(piercePlane({{0.25, 0.25, 1}, {0, 0, 0}}, kUnit));
  EXPECT_FALSE(piercePlane({{0.25, 0.25, 1}, {0, std::nan(""), -1}}, kUnit));
}

// Returns a sphere of facets, whose coordinates are arbitrary floats.
Mesh facetedSphere(const Vec3d& center, double radius, int rings, int sectors) {
  Mesh mesh;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const double polar = 3.14159265358979 * i / rings, turn = 6.28318530717958 * j / sectors;
      Vec3d d{std::sin(polar) * std::cos(turn), std::cos(polar), std::sin(polar) * std::sin(turn)};
      // All corners of a pole are one point.
      if (i == 0) d = {0, 1, 0};
      if (i == rings) d = {0, -1, 0};
      mesh.positions.push_back(Vec3f(center + d * radius));
    }
  }

  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const int k = (j + 1) % sectors;
      const auto at = [&](int ring, int sector) {
        return static_cast<std::uint32_t>(ring * sectors + sector);
      };

      if (i > 0) mesh.triangles.push_back({at(i, j), at(i, k), at(i + 1, j)});
      if (i + 1 < rings) mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, j)});
    }
  }

  mesh.materials = {0};
  return mesh;
}

// Hard cases H12-H14: from inside a closed mesh every ray hits, also towards edges and corners, and
// far from the origin.
TEST(Triangle, ClosedMeshHasNoGaps) {
  for (const Vec3d& center : {Vec3d{0, 0, 0}, Vec3d{148376, 1234, -223423}}) {
    SceneBuilder builder;
    builder.add(facetedSphere(center, 2, 12, 16));
    const Scene scene = builder.build();
    const BruteForce bruteForce(scene);

    Numbers numbers(1);
    int rays = 0, misses = 0;

    const auto shoot = [&](const Vec3d& from, const Vec3d& target) {
      Candidate candidate;
      ++rays;
      misses += !bruteForce.closest({from, target - from}, candidate);
    };

    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
      const Corners c = worldCorners(scene, i, kNoHit);
      const Vec3d from = center + numbers.direction();
      for (const Vec3d& target : {c[0], c[1], c[2], (c[0] + c[1]) * 0.5, (c[1] + c[2]) * 0.5,
                                  (c[2] + c[0]) * 0.5, (c[0] + c[1] + c[2]) * (1.0 / 3)}) {
        shoot(from, target);
      }
    }

    for (int i = 0; i < 2000; ++i) shoot(center, center + numbers.direction());
    EXPECT_EQ(misses, 0) << "of " << rays << " rays";
  }
}

TEST(BruteForce, FindsTheNearest) {
  SceneBuilder builder;
  for (const float y : {0.0f, 3.0f, 1.0f}) builder.add(test::floorAt(y, 1, 0));
  const Scene scene = builder.build();
  const BruteForce bruteForce(scene);

  Candidate candidate;
  ASSERT_TRUE(bruteForce.closest({{0.5, 9, 0.25}, {0, -1, 0}}, candidate));
  EXPECT_EQ(scene.triangles[candidate.triangle].position[1], 3.0f);
  EXPECT_FALSE(bruteForce.closest({{2, 9, 0}, {0, -1, 0}}, candidate));
}

}  // namespace
}  // namespace whit::reference
