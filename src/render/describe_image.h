// The metadata that an image file carries.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "render/renderer.h"

namespace whit {

// Everything needed to make the image again: version, scene, and each option by its name with
// "auto" resolved. Never a date or a host: the same picture gives the same text.
std::vector<std::pair<std::string, std::string>> describeImage(const Scene& scene,
                                                               const Camera& camera,
                                                               const Renderer& renderer,
                                                               const Film& film,
                                                               const RenderOptions& options);

}  // namespace whit
