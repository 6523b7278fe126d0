#include "render/describe_image.h"

#include "core/option_table.h"
#include "core/option_values.h"
#include "core/version.h"

namespace whit {

std::vector<std::pair<std::string, std::string>> describeImage(const Scene& scene,
                                                               const Camera& camera,
                                                               const Renderer& renderer,
                                                               const Film& film,
                                                               const RenderOptions& options) {
  RenderOptions resolved = options;
  resolved.size = ImageSize{film.image.width, film.image.height};
  resolved.eye = camera.eye;  // also of a camera on a path, which has no name
  resolved.at = camera.at;
  resolved.up = camera.up;
  resolved.fov = camera.fov;
  if (camera.orthographicHeight > 0 || resolved.ortho) resolved.ortho = camera.orthographicHeight;
  if (options.mode == Mode::packets) {
    resolved.packet = renderer.machine().packet;
    resolved.simd = renderer.machine().simd;
  }
  std::vector<std::pair<std::string, std::string>> said{
      {"software", std::string("whit ") + versionText()},
      {"scene", scene.name},
      {"effectsUsed", formatValue(OptionSpec{}, renderer.plan().effects)}};
  for (auto& entry : pictureOptions(resolved)) said.push_back(std::move(entry));
  return said;
}

}  // namespace whit
