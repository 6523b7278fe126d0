// The instant of a scene that moves: it plays by the clock, or the user sets it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/scene.h"
#include "scene/animation.h"

namespace whit::view {

struct Timeline {
  bool there = false;  // the scene moves
  double seconds = 0, length = 0;
  bool playing = false;
  bool loops = true;                    // otherwise it stops at its end
  std::vector<std::string> animations;  // to choose from; empty where there is one only
  std::string animation;                // the animation that plays
  bool another = false;                 // the animation was just chosen and is to be read

  // Goes on by that many seconds. Returns whether it was playing.
  bool step(double later);
  void playOrPause();
  std::optional<double> time() const { return there ? std::optional(seconds) : std::nullopt; }
};

// Returns the timeline of a scene that was just read: at the instant's seconds if it has any,
// otherwise playing from 0.
Timeline timelineOf(const Scene& scene, const Instant& instant);

// Draws a bar at the bottom of the window if the scene moves. Returns whether something was
// changed. Call between ImGui's NewFrame and Render.
bool drawTimeline(Timeline& timeline);

}  // namespace whit::view
