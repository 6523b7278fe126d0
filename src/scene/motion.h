// Values and frames of reference that change with time, and the instant at which a scene is
// evaluated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/affine.h"

namespace whit {

// A value that changes with time, by keys. glTF 2.0 specification, appendix C.
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

// Clamped to the first and the last key.
std::vector<double> valueAt(const Track& track, double time);

// Where something is after some seconds, in the space that it moves in.
using Motion = std::function<Affine(double seconds)>;
using SharedMotion = std::shared_ptr<const Motion>;

// At all times the same.
inline SharedMotion fixedMotion(const Affine& map) {
  return std::make_shared<const Motion>([map](double) { return map; });
}

inline constexpr std::uint32_t kNoNode = 0xffffffffu;

struct RigNode {
  std::uint32_t parent = kNoNode;  // comes before it
  Affine toParent;                 // where its motion takes place
  SharedMotion motion;             // none: it stands still there
  std::string name = {};           // of what is moved by hand: its place in the file
};

// A hierarchy of frames of reference that move, each in the frame of its parent.
using Rig = std::vector<RigNode>;

// From each node's own space to that of the rig.
std::vector<Affine> poseRig(const Rig& rig, double seconds);

// Name of the animation that scene files describe themselves ("motion").
inline constexpr char kSceneMotion[] = "scene";

// An animation of a model's file from 0 to `seconds`; before and after, everything stands still.
struct Animation {
  std::string name;       // the file's, or "animation N", counted from 0
  double seconds = 0;     // the time of its last key
  std::size_t nodes = 0;  // that it moves or deforms
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

}  // namespace whit
