// Camera and film of a frame, as the options ask for them.
#pragma once

#include <cstdint>
#include <limits>

#include "bake/scene.h"
#include "core/options.h"
#include "render/film.h"
#include "render/frame_stats.h"
#include "scene/camera.h"

namespace whit {

// The camera that the options ask for: --camera, changed by the options of forEachCameraOption().
// Throws Error(usage) naming the nearest camera.
Camera chooseCamera(const Scene& scene, const RenderOptions& options);
// The scene's camera path at `seconds`, changed by the same options. Throws Error(usage) when the
// scene has no path.
Camera cameraOnPath(const Scene& scene, const RenderOptions& options, double seconds);
// An empty film of the size and crop that the options ask for. Throws Error(usage) for a crop
// outside the image, Error(limit) when it and what writes it would take more than `maxBytes`.
Film makeFilm(const Scene& scene, const RenderOptions& options,
              std::uint64_t maxBytes = std::numeric_limits<std::uint64_t>::max());
// Throws Error(badScene) for a frame with pixels that are not finite when the options are strict.
void refuseNonFinite(const Scene& scene, const RenderOptions& options, const FrameStats& frame);

}  // namespace whit
