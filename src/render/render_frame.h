// One frame by the pipeline or by the reference, with its progress.
#pragma once

#include "core/progress.h"
#include "render/renderer.h"

namespace whit {

// `progress`, if any, is told of each tile that is finished; a frame traced as one batch
// (--batch frame) has none.
FrameStats renderFrame(Renderer& renderer, Mode mode, const Camera& camera, Film& film,
                       Progress* progress = nullptr);

}  // namespace whit
