// Supplies a model that comes without a scene file with light, a sky and a view, and replaces a
// scene's sky by the one that was asked for.
#pragma once

#include "io/scene/scene_context.h"

namespace whit {

// The share of the sky's light that is taken for ambient around a model, which stands in its own
// way and is lit by lights as well.
inline constexpr double kAmbientOfSky = 0.4;

// Completes a model whose own lights and cameras are there. The sky is the studio, unless none or
// another was asked for, as bright as it suits the lights. `model` is the scene that light and view
// are made for: the same scene, or where it moves the scene at rest.
void supplyView(SceneContext& context, const SceneDescription& model);

// If one was asked for (LoadOptions::sky).
void replaceSky(SceneContext& context);

}  // namespace whit
