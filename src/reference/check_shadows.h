// checkShadows: whether a shadow ray meets nothing that casts shadows.
#pragma once

#include "reference/world.h"

namespace whit::reference {

// `toLight` is not normalized; hits at 0 < t < tFar occlude the light.
inline bool isVisible(const Intersector& intersector, const Ray& toLight, double tFar) {
  return !intersector.occluded(toLight, tFar);
}

// Returns the row that the step writes for the slot that the shadow ray started from.
inline UnshadowedRow checkShadows(const World& world, const Chunk& chunk, std::size_t shadowRay) {
  const ShadowRow s = ShadowRow::at(chunk.shadows, shadowRay);
  const Ray toLight{s.org, s.dir};
  UnshadowedRow row = UnshadowedRow::at(chunk.unshadowed, s.slot);
  row.visible = isVisible(world.intersector, toLight, s.tFar) ? 1 : 0;
  return row;
}

}  // namespace whit::reference
