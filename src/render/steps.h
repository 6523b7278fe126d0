// Steps of a plan that are no kernels, besides those of accel/accel.h, render/settle_coplanar.h and
// render/initial_media.h.
#pragma once

#include "stages/chunk.h"

namespace whit {

// Replaces decideShadows (--shadow-cache audit): it does the same, traces every ray that was
// decided, and stores the first ray that contradicts the cache in the chunk's meter.
void auditShadows(Chunk& c);

// Rounds radiance to what the film keeps (--film), encodes it where display codes are wanted, and
// writes both to the pixels.
void updateImage(Chunk& c);

// Display codes of the chunk's radiance, as --exposure, --tonemap and --srgb say.
void encodeForDisplay(Chunk& c);

// Pixels of the chunk that are not finite.
std::uint64_t countNonFinite(const Chunk& c);

// Stores all channels of the surfels of depth 0 except the ray counts.
void keepChannels(Chunk& c);

// Rays are counted where they are traced, and the counts follow the way of the radiance: each ray
// is one, with its shadow rays and all that its children bring back.
void countRays(Chunk& c);
void countShadowRays(Chunk& c);  // of the light in hand
void returnRayCounts(Chunk& c);  // to the parents
void keepRayCounts(Chunk& c);

}  // namespace whit
