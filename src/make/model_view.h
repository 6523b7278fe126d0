// How a model without a camera is shown, and how bright the lights of a model are.
#pragma once

#include "scene/description.h"

namespace whit {

struct ModelView {
  Vec3d center;
  double radius = 0;  // of the sphere around its bounds; 0: there is nothing to see
  // True if the model is a closed room: the fronts of its surfaces surround its middle.
  bool inside = false;
  Camera camera;
  Vec3d ceiling;  // in a room, where a lamp would hang
};

// From the front, a little to the right and above, near enough to fill the picture; from another
// side where the model turns its back or its edge there; and from inside a closed room.
ModelView viewOf(const SceneDescription& scene);
// Returns a view of a model that moves, from the side that suits it now and so far away that all of
// it stays in the picture from 0 to `seconds`. A room is seen as it is now.
ModelView viewOf(const SceneDescription& scene, double seconds);

// The mean brightness of white surfaces that the lights reach, without shadows: the mean, over
// their area, of the logarithm of irradiance / pi. It is 0 where no light reaches any.
double lightLevel(const SceneDescription& scene);

}  // namespace whit
