// Compares the shadow cache with the rays that it replaces (--shadow-cache audit).
#pragma once

#include "render/frame.h"
#include "stages/chunk.h"

namespace whit {

// A step that replaces decideShadows: it does the same, traces every ray that was decided, and
// stores the first ray that contradicts the cache in the chunk's meter.
void auditShadows(Chunk& c);

// Throws Error(checkFailed), naming light, triangle and ray, if one was.
void requireRightShadows(const FrameStats& stats, const Scene& scene);

}  // namespace whit
