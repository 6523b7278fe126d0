// The timeline holds the instant of a scene that moves.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/scene.h"
#include "io/load_scene.h"

namespace whit::view {

// The instant follows the clock, or the user sets it.
struct Timeline {
  bool there = false;  // the scene moves
  double seconds = 0, length = 0;
  bool playing = false;
  std::vector<std::string> animations;  // to choose from; empty where there is one only
  std::string animation;                // the animation that plays

  // Goes on by that many seconds. Returns whether it was playing.
  bool step(double later);
  std::optional<double> time() const { return there ? std::optional(seconds) : std::nullopt; }
};

// Returns the timeline of a scene that was just read: at the instant's seconds if it has any,
// otherwise playing from 0.
Timeline timelineOf(const Scene& scene, const Instant& instant);

}  // namespace whit::view
