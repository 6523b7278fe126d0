// generateRays: rays from the eye through the image plane.
#pragma once

#include "reference/reference.h"
#include "reference/world.h"

namespace whit::reference {

// Through image position (x, y), in pixels from the top left; unit direction.
Ray generateRay(const CameraFrame& camera, double x, double y);

// The ray of a sample of the pixel through this place in it, and the path that it begins.
struct PrimaryRay {
  Ray ray;
  Path path;
};
PrimaryRay primaryRay(const CameraFrame& camera, int x, int y, const Vec2f& at, std::size_t sample);

// The row that the step generateRays writes.
RayRow generateRays(const World& world, const Chunk& chunk, std::size_t slot);

}  // namespace whit::reference
