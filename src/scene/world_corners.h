// Triangles where they stand.
#pragma once

#include <array>
#include <cstdint>

#include "scene/scene.h"

namespace whit {

using Corners = std::array<Vec3d, 3>;

// Of a triangle of the scene (an index into Scene::triangles), carried by the instance unless that
// is kNoInstance.
Corners worldCorners(const Scene& scene, std::uint32_t triangle, std::uint32_t instance);

// Whether the eye lies in the triangle's plane as far as the eye's coordinates can tell. It then
// sees nothing of the triangle, on whichever side a rounded distance of next to 0 would put it.
bool liesInPlane(const Vec3d& eye, const Corners& corners);

// Along a ray from the eye: how far, in lengths of its direction, what lies in the eye is passed
// over at the first attempt; twice as far at each further one.
double wayPastEye(const Vec3d& eye, int attempt);
inline constexpr int kAttemptsPastEye = 40;

}  // namespace whit
