// Where a ray meets a triangle or a sphere, in double precision. On a sphere the hit's weights say
// which point of the unit sphere it is (bake/sphere.h).
#pragma once

#include <optional>
#include <vector>

#include "bake/facet.h"
#include "bake/scene.h"
#include "bake/sphere.h"
#include "surfaces/intersector.h"

namespace whit {

inline constexpr double kUnitRoundOff = 0x1p-24;  // unit round-off of floats

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

// Computes the hit that a candidate stands for again. On triangles u, v >= 0, u + v <= 1, t > 0: a
// hit that rounding has put just beside the triangle is moved onto it. Where the intersection is
// undefined, the candidate's own u and v are used.
TriangleHit refineHit(const Scene& scene, const Ray& ray, const Candidate& candidate);

inline Vec3d triple(const float* values) { return {values[0], values[1], values[2]}; }

// Returns at the hit what is given at the corners.
inline Vec3d interpolate(const float* corners, const TriangleHit& hit) {
  return triple(corners) * (1 - hit.u - hit.v) + triple(corners + 3) * hit.u +
         triple(corners + 6) * hit.v;
}

// The edges of a triangle that lead from corner 0 to corners 1 and 2.
struct Edges {
  Vec3d e1, e2;
};

Edges edgesOf(const TriangleRecord& triangle);

// Returns the normal on the outside of a triangle, in the world and of any length.
Vec3d outwardNormal(const Scene& scene, std::uint32_t triangle, std::uint32_t instance);

}  // namespace whit
