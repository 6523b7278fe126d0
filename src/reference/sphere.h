// Where a ray meets a sphere, in double precision. The hit's weights say which point of the unit
// sphere it is (scene/sphere.h).
#pragma once

#include <vector>

#include "bake/scene.h"
#include "reference/triangle.h"

namespace whit::reference {

// Returns none, one or two hits with t > 0, the nearer one first.
std::vector<TriangleHit> intersectSphere(const Ray& ray, const Affine& fromUnit);

// The one that the candidate stands for, computed again.
TriangleHit refineSphereHit(const Scene& scene, const Ray& ray, const Candidate& candidate);

// Chooses among coincident spheres by the rule for coplanar triangles: an opaque sphere comes
// first, then a sheet, then the dielectric of highest priority, and of equals the last in the
// scene. A sphere does not count where its mask cuts it away.
Candidate settleSpheres(const Scene& scene, EffectSet effects, const Ray& ray,
                        const Candidate& met);

}  // namespace whit::reference
