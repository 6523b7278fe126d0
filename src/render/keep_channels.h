// Steps of a plan that keep channels of its pixels (--channels), and none of a plan that keeps
// none.
#pragma once

#include "stages/chunk.h"

namespace whit {

// Stores all channels of the surfels of depth 0 except the ray counts.
void keepChannels(Chunk& c);

// Rays are counted where they are traced, and the counts follow the way of the radiance: each ray
// is one, with its shadow rays and all that its children bring back.
void countRays(Chunk& c);
void countShadowRays(Chunk& c);  // of the light in hand
void returnRayCounts(Chunk& c);  // to the parents
void keepRayCounts(Chunk& c);

}  // namespace whit
