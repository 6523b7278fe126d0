// Where a ray meets a sphere, in double precision. The hit's weights say which point of the unit
// sphere it is (scene/sphere.h).
#pragma once

#include <vector>

#include "bake/scene.h"
#include "reference/triangle.h"

namespace whit::reference {

// From the unit sphere to the world; `instance`: kNoHit, or that which carries the sphere.
Affine sphereInWorld(const Scene& scene, std::uint32_t number, std::uint32_t instance);

// Returns none, one or two hits with t > 0, the nearer one first.
std::vector<TriangleHit> intersectSphere(const Ray& ray, const Affine& fromUnit);

// The one that the candidate stands for, computed again.
TriangleHit refineSphereHit(const Scene& scene, const Ray& ray, const Candidate& candidate);

}  // namespace whit::reference
