// checkShadows: whether a shadow ray meets nothing that casts shadows.
#pragma once

#include "reference/twin.h"

namespace whit::reference {

// `toLight` is not normalized; what lies at 0 < t < tFar is in the way.
inline bool isVisible(const Intersector& intersector, const Ray& toLight, double tFar) {
  return !intersector.occluded(toLight, tFar);
}

// The row that the step writes for the slot that the shadow ray started from.
UnshadowedRow checkShadows(const World& world, const Chunk& chunk, std::size_t shadowRay);

}  // namespace whit::reference
