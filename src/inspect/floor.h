// The floor: what Embree alone takes of a frame. No pipeline around it can be faster.
#pragma once

#include <cstdint>

#include "render/renderer.h"

namespace whit {

struct FloorResult {
  double floorMs = 0;  // Embree alone, the same rays in full packets
  double frameMs = 0;  // whole frames, rendered in turn with the replays
  std::uint64_t rays = 0;
};

// Captures the rays of one frame, then in turn renders a frame and replays its rays through Embree
// alone, `frames` times each, and returns the medians.
FloorResult measureFloor(Renderer& renderer, const Camera& camera, Film& film, int frames);

}  // namespace whit
