// How a model without a camera is shown.
#pragma once

#include "scene/description.h"

namespace whit {

// The picture is larger than the model by this factor.
inline constexpr double kModelMargin = 1.06;

struct ModelView {
  Vec3d center;
  double radius = 0;  // radius of the sphere around its bounds; 0: the scene is empty
  // The model is a closed room: fronts of surfaces surround its middle, and vertex normals, several
  // materials or flat walls say that this is meant.
  bool inside = false;
  Camera camera;
  Vec3d ceiling;  // the place of a lamp in a room
};

// Returns a view from the front, a little to the right and above, that fills the picture; from
// another side if the model turns its back or its edge there; or from inside a closed room.
// SceneDescription::viewpoint replaces the choice between outside and inside, `azimuth` the side,
// and `zoom` divides the distance.
ModelView viewOf(const SceneDescription& scene);
// Returns a view of a moving model, so far away that it stays in the picture from 0 to `seconds`.
// The side, and the view of a room, are those of the present time.
ModelView viewOf(const SceneDescription& scene, double seconds);

// False if all triangles lie outside of the camera's picture of the scene's size. Only perspective
// and parallel rays without a matrix are looked at; other cameras are taken to see something.
bool seesSomething(const SceneDescription& scene, const Camera& camera);

}  // namespace whit
