// A step after findHits, in scenes in which triangles share their place.
#pragma once

#include "stages/chunk.h"

namespace whit {

// Hits on such triangles are settled by the rule of reference/settle_flush.h, in double, one by
// one.
void settleFlush(Chunk& c);

}  // namespace whit
