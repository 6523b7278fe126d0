// The rays of a pixel drawn as lines over a picture of their scene, as in Whitted's figure of 1980.
#pragma once

#include <string>

#include "render/ray_tree.h"

namespace whit::cli {

// Where the rays are seen from unless the user says so: from aside and above, with all that they
// met in view.
Camera diagramCamera(const RayTree& tree, const Camera& camera);

// An SVG of the picture's size. `picture` is a PNG of the scene by that camera. Reflected rays are
// red, refracted ones blue, primary ones white; shadow rays are dashed, yellow where they reach
// their light and black where they do not. Rays that leave the scene end after a fifth of the
// tree's extent; those that weigh less are thinner.
std::string rayDiagram(const RayTree& tree, const Camera& camera, int width, int height,
                       const std::string& picture);

}  // namespace whit::cli
