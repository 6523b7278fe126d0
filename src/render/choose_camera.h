// The camera of a frame.
#pragma once

#include "bake/scene.h"
#include "core/options.h"
#include "scene/camera.h"

namespace whit {

// The camera of a scene with this origin, changed by the options of forEachCameraOption(). Throws
// Error(usage) for a field of view of a camera that has none.
Camera aimed(Camera camera, const Vec3d& origin, const RenderOptions& options);
// The camera that the options ask for: --camera, changed by the options of forEachCameraOption().
// Throws Error(usage) naming the nearest camera.
Camera chooseCamera(const Scene& scene, const RenderOptions& options);
// The scene's camera path at `seconds`, changed by the same options. Throws Error(usage) when the
// scene has no path.
Camera cameraOnPath(const Scene& scene, const RenderOptions& options, double seconds);

}  // namespace whit
