// Finds out if a scene is closed around its cameras.
#pragma once

#include "accel/accel.h"

namespace whit {

// True if 256 rays from there, evenly in all directions, meet something.
bool isEnclosed(const Accel& accel, const Vec3f& eye);
// True if the scene is closed around every camera and keyframe.
bool isEnclosed(const Scene& scene, const Accel& accel);

}  // namespace whit
