// How a model without a camera is shown, how bright the lights of a model are, the sky of a
// photographer's studio for models without an environment of their own, and cameras that circle
// around a model as if it stood on a turntable.
#pragma once

#include "scene/description.h"
#include "scene/light.h"

namespace whit {

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

// The mean brightness of white surfaces that the lights reach, without shadows: the mean, over
// their area, of the logarithm of irradiance / pi. It is 0 where no light reaches any.
double lightLevel(const SceneDescription& scene);

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

inline constexpr const char* kStudio = "studio";

// A gray gradient with three soft boxes, which lie above the part that is visible beside a model.
Sky studioSky();

}  // namespace whit
