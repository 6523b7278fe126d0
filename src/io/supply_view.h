// Adds light, a sky and a view to a model without a scene file, and replaces a scene's sky by the
// one that --sky names.
#pragma once

#include <cstdint>
#include <string>

#include "core/warnings.h"
#include "io/scene/scene_context.h"

namespace whit {

// The share of the sky's light that becomes ambient light around a model: the model occludes part
// of the sky, and lights shine as well.
inline constexpr double kAmbientOfSky = 0.4;

// Completes a model whose own lights and cameras are there. The sky is the studio, unless none or
// another was asked for, as bright as it suits the lights.A supplied camera, and lights
// with it, hold all of the animation that is played.
void supplyView(SceneContext& context);

// Replaces the scene's sky if LoadOptions::sky names another.
void replaceSky(SceneContext& context);

inline constexpr const char* kNoSky = "none";

// Makes the sky for kNoSky, "studio" (make/studio_sky.h) or the file of an equirectangular image.
// The file and its decoded texels may take `mostBytes`. Throws as readRawImage() does.
Sky namedSky(const std::string& name, std::uint64_t mostBytes, Warnings& warnings);

}  // namespace whit
