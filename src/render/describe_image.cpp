#include "render/describe_image.h"

#include "core/option_table.h"
#include "core/option_values.h"
#include "core/version.h"
#include "scene/members.h"

namespace whit {

std::vector<std::pair<std::string, std::string>> describeImage(const Scene& scene,
                                                               const Camera& camera,
                                                               const Renderer& renderer,
                                                               const Film& film,
                                                               const RenderOptions& options) {
  RenderOptions resolved = options;
  resolved.size = ImageSize{film.image.width, film.image.height};
  // A camera on a path has no name, so its members are written: all but numbers that are 0, which
  // nobody asked for.
  forEachCameraOption([&](auto option, auto member) {
    const auto& value = camera.*member;
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, float>) {
      if (value == 0 && !(options.*option)) return;
    }
    resolved.*option = value;
  });
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
