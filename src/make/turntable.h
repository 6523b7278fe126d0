// A camera that goes around what it looks at, as if that stood on a turntable.
#pragma once

#include "make/model_view.h"
#include "scene/description.h"

namespace whit {

struct Turntable {
  Camera camera;  // where it starts
  Vec3d pivot;    // a point of the axis that it goes around
  Vec3d axis{0, 1, 0};
};

// The camera, light staying where it is, after so many turns. Counter-clockwise as seen against the
// axis: what stands there seems to turn clockwise.
Camera turned(const Turntable& turntable, double turns);

// Around the upright axis through the middle of the scene, from the side and the height that
// viewOf() takes, and so far away that all of it stays in a picture of this size. In a closed room
// it looks around from where it is.
Turntable aroundModel(const SceneDescription& scene, const ModelView& view, int width, int height);
// From the camera, around the line through the point that it looks at, in its direction up.
Turntable aroundTarget(const Camera& camera);

}  // namespace whit
