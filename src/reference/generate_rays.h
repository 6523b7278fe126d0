// generateRays: rays from the eye through the image plane.
#pragma once

#include "reference/twin.h"

namespace whit::reference {

// Through image position (x, y), in pixels from the top left; unit direction.
Ray generateRay(const CameraFrame& camera, double x, double y);

// The twin.
RayRow generateRays(const World& world, const Chunk& chunk, std::size_t slot);

}  // namespace whit::reference
