// Rays against triangles in double precision, one by one and by brute force.
#include "surfaces/intersect.h"

#include <gtest/gtest.h>

#include "reference/small_scenes.h"
#include "shapes/generated.h"

namespace whit::reference {
namespace {

using namespace test;

const Corners kUnit{Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}};

TEST(Triangle, HitOfEitherSideHasDistanceAndWeights) {
  for (const double side : {1.0, -1.0}) {
    const auto hit = intersectTriangle({{0.25, 0.5, 3 * side}, {0, 0, -2 * side}}, kUnit);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->t, 1.5);  // in lengths of the direction
    EXPECT_EQ(hit->u, 0.25);
    EXPECT_EQ(hit->v, 0.5);
  }
}

TEST(Triangle, IsMissedBesideBehindAndInItsPlane) {
  for (const Ray& ray : {Ray{{0.75, 0.5, 1}, {0, 0, -1}},
                         {{-0.01, 0.5, 1}, {0, 0, -1}},
                         {{0.25, 0.25, 1}, {0, 0, 1}},
                         {{0.25, 0.25, 0}, {0, 0, 1}},  // t = 0 is no hit
                         // Hard case H21.
                         {{-1, 0.25, 0}, {1, 0, 0}},
                         {{0.25, 0.25, 0}, {1, 0, 0}}}) {
    EXPECT_FALSE(intersectTriangle(ray, kUnit)) << ray.origin.x << ' ' << ray.direction.z;
  }
}

TEST(Triangle, WithoutAreaOrDirectionMisses) {
  const Corners line{Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{2, 0, 0}};
  EXPECT_FALSE(piercePlane({{0.5, 0, 1}, {0, 0, -1}}, line));
  EXPECT_FALSE(piercePlane({{0.25, 0.25, 1}, {0, 0, 0}}, kUnit));
  EXPECT_FALSE(piercePlane({{0.25, 0.25, 1}, {0, std::nan(""), -1}}, kUnit));
}

// Returns a sphere of facets, whose coordinates are arbitrary floats.
Mesh facetedSphere(const Vec3d& center) {
  Mesh mesh = meshOf("sphere", "'radius': 2, 'segments': 16, 'rings': 12");
  transform(mesh, Affine::translation(center));
  mesh.materials = {0};
  return mesh;
}

// Hard cases H12-H14: from inside a closed mesh every ray hits, also towards edges and corners, and
// far from the origin.
TEST(Triangle, ClosedMeshHasNoGaps) {
  for (const Vec3d& center : {Vec3d{0, 0, 0}, Vec3d{148376, 1234, -223423}}) {
    SceneBuilder builder;
    builder.add(facetedSphere(center));
    const Scene scene = builder.build();
    const BruteForce bruteForce(scene);

    Numbers numbers(1);
    Candidate candidate;
    const auto hits = [&](const Vec3d& from, const Vec3d& target) {
      return bruteForce.closest({from, target - from}, candidate);
    };

    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
      const Corners c = worldCorners(scene, i, kNoHit);
      const Vec3d from = center + numbers.direction();
      for (const Vec3d& target : {c[0], c[1], c[2], (c[0] + c[1]) * 0.5, (c[1] + c[2]) * 0.5,
                                  (c[2] + c[0]) * 0.5, (c[0] + c[1] + c[2]) * (1.0 / 3)}) {
        EXPECT_TRUE(hits(from, target)) << "triangle " << i;
      }
    }

    for (int i = 0; i < 2000; ++i) EXPECT_TRUE(hits(center, center + numbers.direction()));
  }
}

}  // namespace
}  // namespace whit::reference
