// What a frame's options say about camera and film.
#include <cmath>

#include "core/error.h"
#include "core/nearest_name.h"
#include "render/renderer.h"

namespace whit {

Camera chooseCamera(const Scene& scene, const RenderOptions& options) {
  Camera camera = scene.cameras.front();
  if (!options.camera.empty()) {
    std::vector<std::string> names;
    const Camera* found = nullptr;
    for (const Camera& c : scene.cameras) {
      names.push_back(c.name);
      if (c.name == options.camera) found = &c;
    }
    if (!found) {
      throwUsage("scene '" + scene.name + "' has no camera '" + options.camera + "'; nearest: '" +
                 nearestName(options.camera, names) + "'");
    }
    camera = *found;
  }
  if (options.eye) camera.eye = *options.eye;
  if (options.at) camera.at = *options.at;
  if (options.up) camera.up = *options.up;
  if (options.fov) camera.fov = *options.fov;
  return camera;
}

Film makeFilm(const Scene& scene, const RenderOptions& options) {
  const ImageSize size = options.size.value_or(ImageSize{scene.width, scene.height});
  const Crop window = options.crop.value_or(Crop{0, 0, size.width, size.height});
  if (window.x0 < 0 || window.y0 < 0 || window.x1 > size.width || window.y1 > size.height ||
      window.x0 >= window.x1 || window.y0 >= window.y1) {
    throwUsage("--crop must lie within the image of " + std::to_string(size.width) + "x" +
               std::to_string(size.height) + " pixels and hold at least one");
  }
  Film film;
  film.image = Image(size.width, size.height, window);
  return film;
}

}  // namespace whit
