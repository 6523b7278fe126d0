// Members of a scene's description that are set between frames.
#pragma once

#include "bake/scene.h"
#include "io/load_scene.h"
#include "io/scene/scene_settings.h"

namespace whit {

// Sets the member in `document` and does to `scene`, which was read of it with `options`, what a
// reader would have done, bit for bit: to lights, colors of the sky, ambient light, numbers of
// materials, and of scenes without instances to cameras and the image size. Without a document (a
// model) to lights. False, with nothing done: the scene has to be read again with the setting,
// since geometry, images, their number or what moves would be others. Throws as the reader does,
// with nothing done. Renderers of the scene have to be told (Renderer::shadingChanged,
// camerasChanged) before their next frame.
bool editScene(const SceneSetting& setting, const LoadOptions& options, JsonDocument* document,
               Scene& scene);

}  // namespace whit
