// The floor: what Embree alone takes of a frame. No pipeline around it can be faster.
#pragma once

#include "render/renderer.h"

namespace whit {

// Captures the rays of one frame and replays them through Embree alone, in full packets. Returns
// the milliseconds that the replay takes.
double measureFloor(Renderer& renderer, const Camera& camera, Film& film);

}  // namespace whit
