// generateRays: rays from the eye through the image plane.
#pragma once

#include "reference/reference.h"
#include "reference/world.h"

namespace whit::reference {

// Returns the ray through image position (x, y), in pixels from the top left, from the center of
// the lens. Its direction has unit length.
Ray generateRay(const CameraFrame& camera, double x, double y);

// The ray of a sample through the place `at` in its pixel, and the path that the ray begins.
struct PrimaryRay {
  Ray ray;
  Path path;
};
PrimaryRay primaryRay(const CameraFrame& camera, int x, int y, const Vec2f& at, std::size_t sample);

// The row that the step generateRays writes.
RayRow generateRays(const World& world, const Chunk& chunk, std::size_t slot);

}  // namespace whit::reference
