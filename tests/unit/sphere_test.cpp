// Exact spheres: the weights of a hit, intersections with lines, and how spheres are baked.
#include "bake/sphere.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "bake/facet.h"
#include "make/shape.h"
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

TEST(ExactSphere, WeightsNameEachPointOfTheUnitSphere) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 2000; ++i) {
    const Vec3d q = anyDirection(random);
    const auto [u, v] = sphereWeights(q);
    EXPECT_LE(length(spherePoint(u, v) - q), kDoubleRounding);

    // The weights are as inside a triangle, away from its edges.
    EXPECT_GE(std::min({u, v, 1 - u - v}), 0x1p-11);
  }

  for (const Vec3d& axis : {Vec3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
    for (const Vec3d& q : {axis, -axis}) {
      const auto [u, v] = sphereWeights(q);
      EXPECT_LE(length(spherePoint(u, v) - q), kDoubleRounding);
    }
  }
}

// A weight is rounded by 2^-27, or by 2^-26 near its upper end. A coordinate on the octahedron is
// off by eight times that, and the third coordinate by the sum of two. From the middle of a face to
// the sphere, the error grows by the root of 3.
TEST(ExactSphere, WeightsInFloatMoveThePointByFewUlps) {
  std::mt19937_64 random(8);
  for (int i = 0; i < 2000; ++i) {
    const Vec3d q = anyDirection(random);
    const auto [u, v] = sphereWeights(q);
    const Vec3d back = spherePoint(double{static_cast<float>(u)}, double{static_cast<float>(v)});
    EXPECT_LE(length(back - q), std::sqrt(1.0 + 1 + 4) * std::sqrt(3.0) * 0x1p-23);
  }
}

TEST(ExactSphere, HasTheTextureCoordinatesOfItsTessellation) {
  Mesh mesh = ballsOf({Affine()});
  procedural::tessellateSpheres(mesh, 24);
  ASSERT_TRUE(mesh.spheres.empty());

  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3d q(mesh.positions[i]);
    const auto [u, v] = sphereUv(normalized(q));
    EXPECT_NEAR(v, double{mesh.uvs[i].y}, 1e-6);

    // At the poles all azimuths coincide, and at the seam the first and the last.
    if (std::hypot(q.x, q.z) < 1e-3) continue;
    const double off = std::fabs(u - double{mesh.uvs[i].x});
    EXPECT_LE(std::min(off, 1 - off), 1e-6) << q.x << ' ' << q.y << ' ' << q.z;
  }
}

// Along the edges of the triangle, texture coordinates and points grow as they do on the sphere.
TEST(ExactSphere, TouchingTriangleFollowsTheSurface) {
  const Affine map = Affine::translation({5, 1, -2}) * Affine::rotation({1, 2, 3}, 40) *
                     Affine::scaling({1, -2, 0.5});
  const TriangleRecord sphere = makeSphereRecord(map, 3);

  std::mt19937_64 random(9);
  for (int i = 0; i < 200; ++i) {
    const Vec3d q = anyDirection(random);
    if (std::hypot(q.x, q.z) < 0.1) continue;
    const auto [u, v] = sphereWeights(q);
    const TriangleRecord t = touchingTriangle(sphere, u, v);
    EXPECT_EQ(t.material, 3u);

    for (const int corner : {1, 2}) {
      const double du = double{t.uv[2 * corner]} - double{t.uv[0]},
                   dv = double{t.uv[2 * corner + 1]} - double{t.uv[1]};

      // The derivative of the surface along the change of the coordinates, by central differences.
      constexpr double kStep = 1e-6;
      const auto at = [&](double s, double w) {
        const double turn = 2 * M_PI * s, rise = M_PI * (w - 0.5);
        return map.point(
            {std::cos(rise) * std::cos(turn), std::sin(rise), -std::cos(rise) * std::sin(turn)});
      };

      const auto [s, w] = sphereUv(q);
      const Vec3d growth =
          (at(s + du * kStep, w + dv * kStep) - at(s - du * kStep, w - dv * kStep)) / (2 * kStep);

      const Vec3d edge(double{t.position[3 * corner]}, double{t.position[3 * corner + 1]},
                       double{t.position[3 * corner + 2]});
      EXPECT_LE(length(growth - edge), 1e-5) << i;
    }

    // The triangle is counter-clockwise as seen from outside, although the transform mirrors.
    const Vec3d e1(double{t.position[3]}, double{t.position[4]}, double{t.position[5]});
    const Vec3d e2(double{t.position[6]}, double{t.position[7]}, double{t.position[8]});
    EXPECT_GT(dot(cross(e1, e2), map.normal(q)), 0);
  }
}

TEST(ExactSphere, IsMetWhereItsEquationSays) {
  std::mt19937_64 random(10);
  std::uniform_real_distribution<double> any(-3, 3);
  int met = 0;
  for (int i = 0; i < 2000; ++i) {
    const Affine map = Affine::translation({any(random), any(random), any(random)}) *
                       Affine::rotation(anyDirection(random), 50 * any(random)) *
                       Affine::scaling({1, 0.3, 2});

    const Vec3d origin{any(random), any(random), any(random)}, direction = anyDirection(random);
    const auto roots = meetSphere(map, origin, direction);
    if (!roots) continue;

    ++met;
    EXPECT_LE(roots->near, roots->far);
    for (const double t : {roots->near, roots->far}) {
      EXPECT_NEAR(length(onUnitSphere(map, origin + direction * t)), 1, 1e-12);
    }
  }

  EXPECT_GT(met, 100);
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
    EXPECT_LT(double{box.lower[axis]}, lower[axis]);
    EXPECT_GT(double{box.upper[axis]}, upper[axis]);
    EXPECT_NEAR(double{box.lower[axis]}, lower[axis], 1e-2);
    EXPECT_NEAR(double{box.upper[axis]}, upper[axis], 1e-2);
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
  builder.add(blackMaterial());
  builder.add(ballsOf({Affine::translation({10, 0, 0}) * Affine::scaling({2, 2, 4})}));
  const Scene scene = builder.build();
  EXPECT_TRUE(liesInSurface(scene, {12, 0, 0}, 0, kNoInstance));
  EXPECT_TRUE(liesInSurface(scene, {10, 0, 4 + 1e-6}, 0, kNoInstance));
  EXPECT_FALSE(liesInSurface(scene, {10, 0, 4 + 1e-4}, 0, kNoInstance));
  EXPECT_FALSE(liesInSurface(scene, {10, 0, 0}, 0, kNoInstance));
}

}  // namespace
}  // namespace whit
