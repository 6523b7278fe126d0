// Verdicts of shadow held against the rays that they stand for (--verdicts audit).
#pragma once

#include "render/frame_stats.h"
#include "stages/chunk.h"

namespace whit {

// A step in the place of decideShadows: does the same, traces every ray that was decided and notes
// the first whose verdict is wrong in the chunk's meter.
void auditShadows(Chunk& c);

// Throws Error(checkFailed), naming light, triangle and ray, if one was.
void requireRightVerdicts(const FrameStats& stats, const Scene& scene);

}  // namespace whit
