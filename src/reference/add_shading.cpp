#include "reference/add_shading.h"

namespace whit::reference {

RadianceRow addShading(const RadianceRow& before, const Chunk& chunk, std::size_t slot) {
  const UnshadowedRow light = UnshadowedRow::at(chunk.unshadowed, slot);
  if (!(light.visible > 0)) return before;
  return {before.r + light.r, before.g + light.g, before.b + light.b};
}

}  // namespace whit::reference
