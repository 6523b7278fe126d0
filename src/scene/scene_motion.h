// Moving cameras and lights, and the rig that moves instances.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/camera.h"
#include "scene/deformation.h"
#include "scene/light.h"
#include "scene/motion.h"

namespace whit {

// Cameras and lights in the space of the node that moves them. A camera without a node follows the
// scene's camera path.
struct MovingCamera {
  std::uint32_t camera = 0, node = kNoNode;
  Camera own;
};
struct MovingLight {
  std::uint32_t light = 0, node = 0;
  Vec3f position, direction;
};

// Transforms a camera or a light by the map from its node to the world. A camera's target is as far
// away as the map says, but never so near, compared with the distance from the origin, that the
// rounding of both would turn the view.
void carry(const Camera& own, const Affine& map, Camera& camera);
void carry(const MovingLight& own, const Affine& map, Light& light);

struct SceneMotion {
  Rig rig;  // instances refer to its nodes
  std::vector<MovingCamera> cameras;
  std::vector<MovingLight> lights;
  double seconds = 0;  // when the scene is looked at
};

}  // namespace whit
