// The scene as its author describes it, before it is baked. Readers and generators fill it in.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera.h"
#include "scene/light.h"
#include "scene/material.h"
#include "scene/mesh.h"
#include "scene/motion.h"
#include "scene/texture.h"

namespace whit {

// Embree ignores triangles with a corner coordinate beyond this (its FLT_LARGE), and takes no rays
// from there.
inline constexpr float kLargestCoordinate = 1.844e18f;

// Names are kept of the first kNamedItems items.
inline constexpr std::size_t kNamedItems = 65536;

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
  double seconds = 0;  // time at which the scene is looked at
};

// The members of a scene that baking leaves as they are.
struct SceneContents {
  std::string name;      // the bare name of the file
  bool isModel = false;  // light, sky and view are supplied where there are none
  // What was subtracted from the coordinates of the file, see scene/origin.h. Whatever a user gives
  // or gets is in coordinates of the file.
  Vec3d origin;
  // A point of the scene in coordinates of the file. Where nothing was moved the bits stay, those
  // of -0 included.
  Vec3d inFile(const Vec3d& point) const { return origin == Vec3d() ? point : point + origin; }
  Affine upright;                              // how the reader has turned a model alone
  int width = 480, height = 300;               // the scene's own image size
  std::map<std::string, std::string> options;  // options of the picture, see applySceneOptions()
  std::vector<Camera> cameras;                 // the first is the default
  std::vector<Keyframe> cameraPath;
  std::vector<Animation> animations;  // those of its models, in the order of reading
  std::vector<std::string> variants;  // likewise
  std::vector<Light> lights;
  Sky sky;
  Ambient ambient;
  Fog fog;
  std::vector<Material> materials;
  std::vector<Texture> textures;
};

// From where a camera looks that is supplied for a model.
enum class Viewpoint : std::uint8_t { automatic, outside, inside };

struct SceneDescription : SceneContents {
  std::vector<Object> objects;
  std::vector<Instance> instances;
  SceneMotion motion;  // given where the scene is to move
  Viewpoint viewpoint = Viewpoint::automatic;
  // Direction of a supplied camera around the vertical axis, in degrees from the front (+z) towards
  // +x, and how much larger than usual it shows the model.
  std::optional<double> azimuth;
  double zoom = 1;
  bool asksForView() const {
    return viewpoint != Viewpoint::automatic || azimuth.has_value() || zoom != 1;
  }
  // How many items its author has placed, and the names of the first kNamedItems. 0: each instance
  // is one, with the name of its object.
  std::uint64_t items = 0;
  std::vector<std::string> itemNames;
};

}  // namespace whit
