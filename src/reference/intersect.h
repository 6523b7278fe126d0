// Where a ray meets a triangle or a sphere, in double precision. On a sphere the hit's weights say
// which point of the unit sphere it is (bake/sphere.h).
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "bake/facet.h"
#include "bake/scene.h"
#include "bake/sphere.h"
#include "reference/intersector.h"

namespace whit::reference {

// t counts in lengths of the ray's direction; u and v weigh corners 1 and 2.
struct TriangleHit {
  double t = 0, u = 0, v = 0;
};

// Returns where the ray's line pierces the triangle's plane, with any t, u and v. None if the ray
// runs along the plane or the triangle has no area.
std::optional<TriangleHit> piercePlane(const Ray& ray, const Corners& corners);

// Returns only hits on the triangle, border included, with t > 0. Nothing slips between triangles
// that share an edge or a corner (Woop, Benthin and Wald 2013, "Watertight ray/triangle
// intersection"; border hits count for every triangle that they touch).
std::optional<TriangleHit> intersectTriangle(const Ray& ray, const Corners& corners);

// Returns none, one or two hits with t > 0, the nearer one first.
inline std::vector<TriangleHit> intersectSphere(const Ray& ray, const Affine& fromUnit) {
  std::vector<TriangleHit> hits;
  const auto roots = meetSphere(fromUnit, ray.origin, ray.direction);
  if (!roots) return hits;

  for (const double t : {roots->near, roots->far}) {
    if (!(t > 0)) continue;
    const auto [u, v] = sphereWeights(onUnitSphere(fromUnit, ray.origin + ray.direction * t));
    hits.push_back({t, u, v});
  }
  return hits;
}

// Computes the hit that the candidate stands for again. If there is none in double precision, the
// hit keeps the candidate's weights.
inline TriangleHit refineSphereHit(const Scene& scene, const Ray& ray, const Candidate& candidate) {
  const Affine map = sphereInWorld(scene, {candidate.triangle, candidate.instance});

  const Vec3d there = map.point(spherePoint(candidate.u, candidate.v));
  const double squared = dot(ray.direction, ray.direction);
  const double hint = dot(there - ray.origin, ray.direction) / squared;

  TriangleHit best{hint > 0 ? hint : std::numeric_limits<double>::min(), candidate.u, candidate.v};
  double least = std::numeric_limits<double>::infinity();

  // The weights name a point, and the nearer of the two hits is kept.
  for (const TriangleHit& hit : intersectSphere(ray, map)) {
    const double off = std::fabs(hit.t - hint);
    if (!(off < least)) continue;
    least = off;
    best = hit;
  }
  return best;
}

}  // namespace whit::reference
