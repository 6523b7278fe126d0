// The exposure that a view calls for (--exposure auto).
#pragma once

#include "core/options.h"
#include "render/renderer.h"

namespace whit {

// In steps of 1/8 EV. Follows from scene, camera, effects and tone curve alone, not from size, crop
// or how the picture is computed: the reference traces a small picture of the scene's own shape
// first.
float exposureFor(const Renderer& renderer, const Camera& camera);

// Gives an automatic exposure of the options its value, and tells the renderer.
void settleExposure(Renderer& renderer, const Camera& camera, RenderOptions& options);

}  // namespace whit
