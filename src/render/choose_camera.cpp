#include "render/choose_camera.h"

#include <algorithm>

#include "core/error.h"
#include "core/text.h"
#include "scene/members.h"

namespace whit {

Camera aimed(Camera camera, const Vec3d& origin, const RenderOptions& options) {
  const bool hasFov = isPerspective(camera) && camera.k.empty();
  if (!hasFov && (options.fov || options.ortho.value_or(0) > 0)) {
    throwUsage("--fov and --ortho: camera '" + camera.name +
               "' has a matrix k or another projection than \"perspective\"");
  }
  if (options.fov && !options.ortho && camera.orthographicHeight > 0) {
    throwUsage("--fov: camera '" + camera.name +
               "' is orthographic and has no field of view; --ortho 0 makes it perspective");
  }
  forEachCameraOption([&](auto option, auto member) {
    if (options.*option) camera.*member = memberOf(*(options.*option), origin);
  });
  if (options.fov || options.ortho) camera.aspect = 0;

  const bool isMoved = options.eye || options.at;
  if (isMoved && camera.eye == camera.at) {
    throwUsage("--eye and --at are the same point, so that the camera looks nowhere");
  }
  return camera;
}

Camera chooseCamera(const Scene& scene, const RenderOptions& options) {
  if (options.camera.empty()) return aimed(scene.cameras.front(), scene.origin, options);

  const auto& cameras = scene.cameras;
  const auto found = std::find_if(cameras.rbegin(), cameras.rend(),
                                  [&](const Camera& c) { return c.name == options.camera; });
  if (found == cameras.rend()) {
    throwUsage("scene '" + scene.name + "' has no camera '" + options.camera + "'" +
               didYouMean(options.camera, namesIn(cameras), "camera"));
  }
  return aimed(*found, scene.origin, options);
}

Camera cameraOnPath(const Scene& scene, const RenderOptions& options, double seconds) {
  if (scene.cameraPath.empty()) throwUsage("scene '" + scene.name + "' has no camera path");
  return aimed(cameraAt(scene.cameraPath, seconds), scene.origin, options);
}

}  // namespace whit
