// How a model without a camera is shown, and how bright the lights of a model are.
#pragma once

#include "scene/description.h"

namespace whit {

struct ModelView {
  Vec3d center;
  double radius = 0;    // of the sphere around its bounds; 0: the scene is empty
  bool inside = false;  // the model is a closed room: fronts of surfaces surround its middle
  Camera camera;
  Vec3d ceiling;  // the place of a lamp in a room
};

// Returns a view from the front, a little to the right and above, that fills the picture; from
// another side if the model turns its back or its edge there; or from inside a closed room.
ModelView viewOf(const SceneDescription& scene);
// Returns a view of a moving model, so far away that it stays in the picture from 0 to `seconds`.
// The side, and the view of a room, are those of the present time.
ModelView viewOf(const SceneDescription& scene, double seconds);

// The mean brightness of white surfaces that the lights reach, without shadows: the mean, over
// their area, of the logarithm of irradiance / pi. It is 0 where no light reaches any.
double lightLevel(const SceneDescription& scene);

}  // namespace whit
