// addShading: the radiance from a light, once its shadow is known.
#pragma once

#include "reference/world.h"

namespace whit::reference {

// Returns the row that the step writes. `before` is the radiance that the step has added to.
inline RadianceRow addShading(const RadianceRow& before, const Chunk& chunk, std::size_t slot) {
  const UnshadowedRow light = UnshadowedRow::at(chunk.unshadowed, slot);
  if (!(light.visible > 0)) return before;
  return {before.rgb + light.rgb};
}

}  // namespace whit::reference
