// The exposure that a view calls for (--exposure auto).
#pragma once

#include "render/renderer.h"

namespace whit {

// Returns the exposure in steps of 1/8 EV. It follows from scene, camera, effects and tone curve
// alone, not from size, crop or how the picture is computed: packets trace a small picture of the
// scene's own shape first. The renderer keeps its options.
float exposureFor(Renderer& renderer, const Camera& camera);

// Gives an automatic exposure of the options its value, and tells the renderer.
void chooseExposure(Renderer& renderer, const Camera& camera, RenderOptions& options);

}  // namespace whit
