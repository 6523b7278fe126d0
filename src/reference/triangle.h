// Where a ray meets one triangle, in double precision.
#pragma once

#include <optional>

#include "bake/facet.h"
#include "reference/intersector.h"

namespace whit::reference {

// t counts in lengths of the ray's direction; u and v weigh corners 1 and 2.
struct TriangleHit {
  double t = 0, u = 0, v = 0;
};

// Where the ray's line pierces the triangle's plane: any t, any u and v. None if the ray runs along
// the plane or the triangle has no area.
std::optional<TriangleHit> piercePlane(const Ray& ray, const Corners& corners);

// Returns only hits on the triangle, border included, with t > 0. Nothing slips between triangles
// that share an edge or a corner (Woop, Benthin and Wald 2013, "Watertight ray/triangle
// intersection"; border hits count for every triangle that they touch).
std::optional<TriangleHit> intersectTriangle(const Ray& ray, const Corners& corners);

}  // namespace whit::reference
