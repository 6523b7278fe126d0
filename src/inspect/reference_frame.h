// Frames by the scalar reference, of what a renderer renders by the pipeline.
#pragma once

#include "core/progress.h"
#include "reference/reference.h"
#include "render/renderer.h"

namespace whit {

// The renderer's effects and options.
reference::Settings referenceSettings(const Renderer& renderer);

// Renders the renderer's image with the scalar reference, which takes its candidates from the same
// Embree scene.
FrameStats renderReference(Renderer& renderer, const Camera& camera, Film& film,
                           Progress* progress = nullptr);

// Renders one frame by the pipeline or by the reference. Each finished tile is reported to
// `progress`, if any; a frame that is traced as one batch (--batch frame) reports none.
FrameStats renderFrame(Renderer& renderer, Mode mode, const Camera& camera, Film& film,
                       Progress* progress = nullptr);

}  // namespace whit
