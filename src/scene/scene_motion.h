// What moves in a scene.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/box.h"
#include "scene/camera.h"
#include "scene/deformation.h"
#include "scene/flush_triangles.h"
#include "scene/light.h"
#include "scene/rig.h"
#include "scene/scene_order.h"

namespace whit {

// Where they stand without the rig, and the node that carries them. A camera without a node flies
// along the scene's camera path.
struct MovingCamera {
  std::uint32_t camera = 0, node = kNoNode;
  Camera own;
};
struct MovingLight {
  std::uint32_t light = 0, node = 0;
  Vec3f position, direction;
};

// Where they are when the node that carries them maps its space to the world like this. A camera's
// target is as far away as the map says, but never so near, compared with the distance from the
// origin, that the rounding of both would turn the view.
void carry(const Camera& own, const Affine& map, Camera& camera);
void carry(const MovingLight& own, const Affine& map, Light& light);

struct SceneMotion {
  Rig rig;  // instances refer to its nodes
  std::vector<MovingCamera> cameras;
  std::vector<MovingLight> lights;
  double seconds = 0;  // when the scene is looked at
};

struct InstanceRecord {
  std::uint32_t geometry = 0;  // index into Scene::geometries, never 0
  std::uint32_t written = 0;   // index into SceneDescription::instances
  Affine toWorld;
  std::uint32_t mover = kNoNode;  // of the scene's rig
  Affine toMover;
  bool moves = false;  // is carried by something, or bends
  std::uint32_t firstItem = 0;
};

// The vertices of a baked geometry that a mesh bends, from `firstVertex` on.
struct BentVertices {
  std::uint32_t geometry = 0, firstVertex = 0;
  std::shared_ptr<const Deformation> deformation;
};

// What moveScene() starts from.
struct BakedMotion {
  SceneMotion given;
  // Instances move, meshes bend, or cameras may go to where instances are too small to be traced.
  // If not, only cameras and lights move, and all below is empty.
  bool ofGeometry = false;
  std::vector<InstanceRecord> instances;  // all of them, also those that are flattened at times
  std::vector<Box> boxes;                 // of geometries, each in its own space
  std::vector<BentVertices> bent;
  SceneOrder order;
  StillFlush still;

  bool ofLights() const { return !given.lights.empty(); }
  bool empty() const { return !ofGeometry && !ofLights() && given.cameras.empty(); }
};

}  // namespace whit
