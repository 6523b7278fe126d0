// The rays of a pixel drawn as lines over a picture of their scene, as in Whitted's figure of 1980.
#pragma once

#include <string>

#include "inspect/ray_lines.h"

namespace whit::cli {

// An SVG of the picture's size. `picture` is a PNG of the scene by that camera. Shadow rays are
// dashed.
std::string rayDiagram(const RayTree& tree, const Camera& camera, int width, int height,
                       const std::string& picture);

}  // namespace whit::cli
