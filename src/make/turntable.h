// Cameras that circle around a model as if it stood on a turntable.
#pragma once

#include "make/model_view.h"

namespace whit {

struct Turntable {
  Camera camera;  // camera at the start
  Vec3d pivot;    // a point of the axis
  Vec3d axis{0, 1, 0};
};

// Returns the camera after a number of turns, counter-clockwise as seen against the axis.
Camera turned(const Turntable& turntable, double turns);

// Circles around the vertical axis through the middle of the scene, from the direction of `view`
// and so far away that the whole scene stays in a picture of this size. In a closed room the camera
// turns around itself.
Turntable aroundModel(const SceneDescription& scene, const ModelView& view, int width, int height);
// Circles around the line through the camera's target along its up vector.
Turntable aroundTarget(const Camera& camera);

}  // namespace whit
