// A room whose corners lie exactly in the middles of pixels.
#pragma once

#include "scene/camera.h"
#include "scene/mesh.h"

namespace whit::stress {

// A closed room with a corner exactly in the middle of every pixel: the wall that is seen, finer
// than the pixels' grid by one all around, and a hood from its border to a point behind the eye.
Mesh roomOfPixels(const CameraFrame& frame);

}  // namespace whit::stress
