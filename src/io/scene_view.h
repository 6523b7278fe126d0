// The sections of a scene file about cameras and light.
#pragma once

#include <optional>

#include "io/json_reader.h"
#include "io/scene_context.h"

namespace whit {

// "size", "cameras" and "path".
void readCameras(JsonObject& file, SceneDescription& scene);
// "lights".
void readLights(JsonObject& file, SceneDescription& scene);
// "sky"; its image is there after context.textures.finish().
void readSky(JsonObject& file, SceneContext& context);
// "ambient". Returns the strength that ambientFromSky() is to be called with, once the sky's image
// is there.
std::optional<double> readAmbient(JsonObject& file, SceneDescription& scene);

}  // namespace whit
