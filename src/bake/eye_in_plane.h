// Surfaces that the eye lies in. It sees nothing of them, on whichever side a rounded distance of
// next to 0 would put it.
#pragma once

#include "bake/facet.h"

namespace whit {

// True if the eye lies in the triangle's plane, up to the rounding of the eye's coordinates.
bool liesInPlane(const Vec3d& eye, const Corners& corners);

// True if the eye lies in a surface of the scene, given by its number: a triangle's plane, or a
// sphere.
bool liesInSurface(const Scene& scene, const Vec3d& eye, std::uint32_t number,
                   std::uint32_t instance);

// Along a ray from the eye: how far, in lengths of its direction, what lies in the eye is passed
// over at the first attempt, numbered 0; twice as far at each further one.
double wayPastEye(const Vec3d& eye, int attempt);
inline constexpr int kAttemptsPastEye = 40;

}  // namespace whit
