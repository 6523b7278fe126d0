// Animations of a scene, and the instant at which the scene is evaluated.
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>

namespace whit {

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
  // The scene is to be moved (scene/move_scene.h), whatever the seconds.
  bool plays = false;
  // It is looked at from its camera's path, where it has one; at given seconds it is anyway.
  bool alongPath = false;
  // JSON pointers to what is moved by hand (setPlace() in scene/move_scene.h): items, cameras and
  // lights of scene files, nodes of glTF models.
  std::set<std::string> movable = {};

  bool moves() const { return plays || seconds || !movable.empty(); }
  bool fliesPath() const { return alongPath || seconds; }
};

}  // namespace whit
