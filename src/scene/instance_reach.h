// Rays are carried into the space of an instance in single precision.
#pragma once

#include "core/affine.h"

namespace whit {

// The largest coordinate with which a ray may start (its direction's length at most 1) so that in
// the instance's own space it stays within kLargestCoordinate, beyond which Embree takes no rays;
// 0 where the inverse of the map has no floats. Embree inverts it as adjoint over determinant.
float instanceReach(const Affine& toWorld);

}  // namespace whit
