// What a model lacks that comes without a scene file: light, a sky, a view. And the sky that was
// asked for in place of a scene's own.
#pragma once

#include "io/scene/scene_context.h"

namespace whit {

// The share of the sky's light that is taken for ambient around a model, which stands in its own
// way and is lit by lights as well.
inline constexpr double kAmbientOfSky = 0.4;

// Of a model whose own lights and cameras are there. The sky is the studio, unless none or another
// was asked for, as bright as it goes with the lights. `model` is what light and view are made for:
// the same scene, or where it moves the scene at rest.
void supplyView(SceneContext& context, const SceneDescription& model);

// If one was asked for (LoadOptions::sky).
void replaceSky(SceneContext& context);

}  // namespace whit
