// The sections of a scene file about cameras and light, as they are read and written.
#pragma once

#include <optional>
#include <vector>

#include "io/json_reader.h"
#include "io/scene/scene_context.h"

namespace whit {

// Reads the members of a camera that are given; the others keep their values.
void readCamera(JsonObject& object, Camera& camera);
// "size", "cameras" and "path". A camera has "eye", "at", "up" and either "fov", vertical in
// degrees, or "orthographicHeight", what parallel rays show of the plane through the eye.
void readCameras(JsonObject& file, const Instant& instant, SceneDescription& scene);
// "lights": see scene/members.h for what each type has. "name" is free.
void readLights(JsonObject& file, const Instant& instant, SceneDescription& scene);
// "sky"; its image is there after context.textures.finish().
void readSky(JsonObject& file, SceneContext& context);
// "ambient". Returns the strength that ambientFromSky() is to be called with, once the sky's image
// is there.
std::optional<double> readAmbient(JsonObject& file, SceneDescription& scene);

// Sections "lights" and "ambient" and one of the "cameras"; reading them gives the same bits.
Json describe(const Camera& camera);
Json describe(const std::vector<Light>& lights);
Json describe(const Ambient& ambient);

}  // namespace whit
