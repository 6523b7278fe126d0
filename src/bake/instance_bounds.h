// The bounds of a scene's instances, and of the rays that can be carried into their space.
#pragma once

#include <vector>

#include "bake/scene.h"
#include "core/box.h"

namespace whit {

// Counts and bounds as seen, from `boxes`: one a geometry, in its own space. Left out are instances
// that are so much smaller or flatter than the scene that its rays, in their space, would leave the
// range of coordinates. Throws Error(badScene) for one that is too far away.
void boundInstances(Scene& scene, const std::vector<Box>& boxes, Warnings& warnings);

// Triangles and spheres as seen.
void countInstanced(Scene& scene);

// The largest coordinate with which a ray may start (its direction's length at most 1) so that in
// the instance's own space it stays within kLargestCoordinate, beyond which Embree takes no rays;
// 0 where the inverse of the map has no floats. Embree inverts it as adjoint over determinant, in
// single precision.
float instanceReach(const Affine& toWorld);

}  // namespace whit
