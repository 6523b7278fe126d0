// Exact spheres: the weights of a hit, and how spheres are baked. Intersections, normals and
// texture coordinates are compared with oracle/spheres_test.cpp.
#include "bake/sphere.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "bake/facet.h"
#include "verify/scene_builder.h"

namespace whit {
namespace {

using verify::blackMaterial;
using verify::SceneBuilder;

// Rounding of doubles of the order of 1.
constexpr double kDoubleRounding = 1e-14;

Vec3d anyDirection(std::mt19937_64& random) {
  std::normal_distribution<double> gauss;
  return normalized(Vec3d{gauss(random), gauss(random), gauss(random)});
}

Mesh ballsOf(const std::vector<Affine>& maps, std::uint32_t material = 0) {
  Mesh mesh;
  mesh.spheres = maps;
  mesh.materials = {material};
  return mesh;
}

// A weight is rounded by 2^-27, or by 2^-26 near its upper end. A coordinate on the octahedron is
// off by eight times that, and the third coordinate by the sum of two. From the middle of a face to
// the sphere, the error grows by the root of 3.
TEST(ExactSphere, WeightsNameEachPointOfTheUnitSphere) {
  const double fewUlps = std::sqrt(1.0 + 1 + 4) * std::sqrt(3.0) * 0x1p-23;
  std::mt19937_64 random(7);
  std::vector<Vec3d> points;
  for (int i = 0; i < 2000; ++i) points.push_back(anyDirection(random));
  for (const Vec3d& axis : {Vec3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
    points.insert(points.end(), {axis, -axis});
  }

  for (const Vec3d& q : points) {
    const auto [u, v] = sphereWeights(q);
    EXPECT_LE(length(spherePoint(u, v) - q), kDoubleRounding);
    EXPECT_LE(length(spherePoint(static_cast<float>(u), static_cast<float>(v)) - q), fewUlps);
    // The weights are as inside a triangle, away from its edges.
    EXPECT_GE(std::min({u, v, 1 - u - v}), 0x1p-11);
  }
}

TEST(ExactSphere, IsMetFarAwayWithoutCancellation) {
  const Affine unit;
  for (const double distance : {1e3, 1e7, 1e12}) {
    const auto roots = meetSphere(unit, {distance, 0.6, 0}, {-1, 0, 0});
    ASSERT_TRUE(roots) << distance;
    EXPECT_NEAR(roots->near, distance - 0.8, 1e-15 * distance);
    EXPECT_NEAR(roots->far, distance + 0.8, 1e-15 * distance);
    EXPECT_FALSE(meetSphere(unit, {distance, 1 + 1e-9, 0}, {-1, 0, 0}));
  }
}

TEST(ExactSphere, BoundsHoldItAndLittleMore) {
  const Affine map = Affine::translation({100, -2, 7}) * Affine::rotation({1, 1, 0}, 30) *
                     Affine::scaling({1, 2, 3});
  const Box box = sphereBounds(map);

  std::mt19937_64 random(11);
  Vec3d lower(1e9), upper(-1e9);
  for (int i = 0; i < 100000; ++i) {
    const Vec3d p = map.point(anyDirection(random));
    lower = min(lower, p);
    upper = max(upper, p);
  }

  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LT(box.lower[axis], lower[axis]);
    EXPECT_GT(box.upper[axis], upper[axis]);
    EXPECT_NEAR(box.lower[axis], lower[axis], 1e-2);
    EXPECT_NEAR(box.upper[axis], upper[axis], 1e-2);
  }
}

TEST(ExactSphere, IsBakedBehindAllTriangles) {
  SceneBuilder builder;
  const auto material = builder.add(blackMaterial());

  builder.add(ballsOf({Affine::translation({9, 0, 0})}, material));
  builder.add(verify::floorAt(0, 1, material));
  Object pair;
  pair.meshes = {ballsOf({Affine(), Affine::scaling({2, 2, 2})}, material)};
  builder.place(std::move(pair), {Affine(), Affine::translation({0, 20, 0})});

  const Scene scene = builder.build();
  EXPECT_EQ(scene.firstSphere, 2u);
  EXPECT_EQ(scene.triangles.size(), 5u);
  EXPECT_EQ(scene.instancedSpheres, 5u);
  EXPECT_EQ(scene.instancedTriangles, 2u);

  EXPECT_EQ(scene.geometries[0].spheres, 1u);
  EXPECT_EQ(scene.geometries[1].spheres, 2u);
  EXPECT_TRUE(scene.isSphere(scene.geometries[1].firstSphere));
  EXPECT_EQ(sphereMap(scene.triangles[2]).p, Vec3d(9, 0, 0));
  EXPECT_GE(scene.upper.y, 22);
  EXPECT_TRUE(scene.effects.has(Effect::spheres));
}

TEST(ExactSphere, IsDroppedWhereItHasNoInside) {
  SceneBuilder builder;
  builder.add(ballsOf({Affine(), Affine::scaling({1, 0, 1}), Affine::translation({4e18, 0, 0}),
                       Affine::translation({NAN, 0, 0})}));
  builder.add(blackMaterial());
  Warnings warnings;
  const Scene scene = Scene::finalize(builder.describe(), warnings);
  EXPECT_EQ(scene.instancedSpheres, 1u);
  EXPECT_EQ(warnings.entries().at("sphere too small, too flat or too far away dropped").count, 3u);
}

TEST(ExactSphere, EyesLieOnItAsFarAsFloatsCanTell) {
  SceneBuilder builder;
  builder.add(ballsOf({Affine::translation({10, 0, 0}) * Affine::scaling({2, 2, 4})},
                      builder.add(blackMaterial())));
  const Scene scene = builder.build();
  for (const auto& [eye, isOnIt] : {std::pair{Vec3d{12, 0, 0}, true},
                                    {Vec3d{10, 0, 4 + 1e-6}, true},
                                    {Vec3d{10, 0, 4 + 1e-4}, false},
                                    {Vec3d{10, 0, 0}, false}}) {
    EXPECT_EQ(liesInSurface(scene, eye, 0, kNoInstance), isOnIt) << eye.x << ' ' << eye.z;
  }
}

}  // namespace
}  // namespace whit
