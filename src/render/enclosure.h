// Whether a scene is closed around its cameras.
#pragma once

#include "accel/accel.h"

namespace whit {

// True if 256 rays from every camera and keyframe, evenly in all directions, meet something.
bool isEnclosed(const Scene& scene, const Accel& accel);

}  // namespace whit
