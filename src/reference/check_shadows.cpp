#include "reference/check_shadows.h"

namespace whit::reference {

UnshadowedRow checkShadows(const World& world, const Chunk& chunk, std::size_t shadowRay) {
  const ShadowRow s = ShadowRow::at(chunk.shadows, shadowRay);
  const Ray toLight{{s.orgX, s.orgY, s.orgZ}, {s.dirX, s.dirY, s.dirZ}};
  UnshadowedRow row = UnshadowedRow::at(chunk.unshadowed, s.slot);
  row.visible = isVisible(world.intersector, toLight, s.tFar) ? 1 : 0;
  return row;
}

}  // namespace whit::reference
