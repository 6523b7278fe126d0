// The motion of the viewer's camera, from its input and the size of the scene.
#pragma once

#include "scene/scene.h"
#include "viewer/camera_control.h"
#include "viewer/input.h"

namespace whit::view {

// Units a second to begin with: the scene from end to end in twelve seconds.
double cruisingSpeed(const Scene& scene);

// What the held keys and the mouse mean for the camera.
CameraMotion motionOf(const Input& input);

}  // namespace whit::view
