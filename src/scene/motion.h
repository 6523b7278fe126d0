// Values and frames of reference that change with time, the instant at which a scene is evaluated,
// and meshes that bend: morph targets, and skins by linear blending (Magnenat-Thalmann, Laperriere
// and Thalmann 1988; glTF 2.0 specification, sections 3.7.2.2 and 3.7.3).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/affine.h"
#include "core/vec3.h"

namespace whit {

// Value that changes with time, given by keyframes. glTF 2.0 specification, appendix C.
struct Track {
  // cubic: Hermite splines through the keys, each with a tangent before and behind it.
  enum class Interpolation { step, linear, cubic };

  Interpolation interpolation = Interpolation::linear;
  // Quaternions (x, y, z, w): linear is along the shorter great arc, and all come out with
  // length 1.
  bool rotation = false;
  std::size_t components = 3;
  std::vector<double> times;  // seconds, increasing, at least one
  // One group of components for each key; with cubic interpolation three groups: the tangent before
  // the key, the value, and the tangent behind it, per second.
  std::vector<double> values;
};

// Returns the value at a time, which is clamped to the first and the last key.
std::vector<double> valueAt(const Track& track, double time);

// Transform at a time, to the space in which the motion takes place.
using Motion = std::function<Affine(double seconds)>;
using SharedMotion = std::shared_ptr<const Motion>;

// Returns a motion that is the same at all times.
inline SharedMotion fixedMotion(const Affine& map) {
  return std::make_shared<const Motion>([map](double) { return map; });
}

inline constexpr std::uint32_t kNoNode = 0xffffffffu;

struct RigNode {
  std::uint32_t parent = kNoNode;  // comes before it
  Affine toParent;                 // map from the space in which it moves
  SharedMotion motion;             // none: it stands still there
  std::string name = {};           // place in the file, if a program moves the node
};

// A hierarchy of frames of reference that move, each in the frame of its parent.
using Rig = std::vector<RigNode>;

// Returns the maps from each node's own space to that of the rig.
std::vector<Affine> poseRig(const Rig& rig, double seconds);

// Name of the animation that scene files describe themselves ("motion").
inline constexpr char kSceneMotion[] = "scene";

// An animation of a model's file from 0 to `seconds`; before and after, everything stands still.
struct Animation {
  std::string name;       // the file's, or "animation N", counted from 0
  double seconds = 0;     // the time of its last key
  std::size_t nodes = 0;  // number of nodes that it moves or deforms
};

struct Instant {
  // Not given: everything is where its file has it without animations, and what scene files move is
  // where it is at 0.
  std::optional<double> seconds;
  // By its name; empty: the first one of each model.
  std::string animation;
  // The scene is to be moved (bake/edit_scene.h), whatever the seconds.
  bool plays = false;
  // It is looked at from its camera's path, where it has one; at given seconds it is anyway.
  bool alongPath = false;
  // JSON pointers to what is moved by hand (setPlace() in bake/edit_scene.h): items, cameras and
  // lights of scene files, nodes of glTF models.
  std::set<std::string> movable = {};

  bool moves() const { return plays || seconds || !movable.empty(); }
  bool fliesPath() const { return alongPath || seconds; }
};

struct MorphTarget {
  std::vector<Vec3f> positions, normals;  // by how much each is moved; empty: not at all
};

// Influence of a joint on a vertex. The weights of a vertex are scaled to the sum 1.
struct Influence {
  std::uint32_t joint = 0;
  double weight = 0;
};

struct Deformation {
  std::vector<Vec3f> positions, normals;  // as they were modelled; normals of all vertices or none
  std::vector<MorphTarget> targets;
  std::vector<double> weights;          // weights of targets; missing ones are zero
  std::optional<Track> movingWeights;   // replaces `weights` if they move
  std::shared_ptr<const Rig> skeleton;  // none: no skin
  struct Joint {
    std::uint32_t node = 0;  // node of the skeleton
    Affine fromMesh;         // map from the mesh as it was modelled to the joint's own space
  };
  std::vector<Joint> joints;
  // Vertex i has the influences from firstInfluence[i] to firstInfluence[i + 1], at least one.
  std::vector<std::uint32_t> firstInfluence;
  std::vector<Influence> influences;
  Vec3d origin;  // subtracted from the deformed positions, see scene/origin.h

  bool hasSkin() const { return skeleton != nullptr; }
  // True if the shape depends on time.
  bool moves() const;
};

struct DeformedVertices {
  std::vector<Vec3f> positions, normals;  // rounded once; normals of unit length, or zero
  // -1 for each vertex that the skin mirrors, 1 for the others; empty without a skin.
  std::vector<double> sides;
};
// True if a skin mirrors more than one corner of a triangle. Its corners then run the other way
// round, and corners 1 and 2 change places.
bool turnsOver(const std::vector<double>& sides, const std::array<std::uint32_t, 3>& corners);

// Weights and joint transforms at one time.
struct DeformationPose {
  std::vector<double> weights;  // weights of targets
  std::vector<Affine> joints;   // maps from the mesh as it was modelled
};
DeformationPose poseAt(const Deformation& deformation, double seconds);

// Applies morph targets first, then joints.
DeformedVertices deformVertices(const Deformation& deformation, const DeformationPose& pose);

}  // namespace whit
