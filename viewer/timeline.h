// When a scene that moves is looked at: it plays by the clock, or is put to a time by hand.
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
  bool loops = true;                    // else it stops at its end
  std::vector<std::string> animations;  // to choose from; of one that plays alone none
  std::string animation;                // the one that plays
  bool another = false;                 // it was chosen just now, and is to be read

  // So many seconds later. Whether it was playing.
  bool step(double later);
  void playOrPause();
  std::optional<double> time() const { return there ? std::optional(seconds) : std::nullopt; }
};

// Of a scene as it was just read: at the instant's seconds where it has some, else playing from 0.
Timeline timelineOf(const Scene& scene, const Instant& instant);

// A bar at the bottom of the window, where the scene moves. Between ImGui's NewFrame and Render.
// Whether something was changed.
bool drawTimeline(Timeline& timeline);

}  // namespace whit::view
