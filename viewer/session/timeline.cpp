#include "viewer/session/timeline.h"

#include <algorithm>
#include <cmath>

namespace whit::view {

bool Timeline::step(double later) {
  if (!there || !playing) return false;
  seconds += later;
  if (seconds > length) seconds = length > 0 ? std::fmod(seconds, length) : 0;
  return true;
}

Timeline timelineOf(const Scene& scene, const Instant& instant) {
  Timeline timeline;
  timeline.seconds = instant.seconds.value_or(0);
  timeline.animation = instant.animation;

  for (const Animation& animation : scene.animations) {
    // A model's first animation plays unless another is named; motions of a scene file always do.
    const bool own = animation.name == kSceneMotion;
    if (!own && timeline.animation.empty()) timeline.animation = animation.name;
    if (!own) timeline.animations.push_back(animation.name);

    if (own || animation.name == timeline.animation) {
      timeline.length = std::max(timeline.length, animation.seconds);
    }
  }

  for (const MovingCamera& camera : scene.motion.given.cameras) {
    if (camera.node != kNoNode) continue;  // without a node it flies along the path
    timeline.length = std::max(timeline.length, static_cast<double>(scene.cameraPath.back().time));
  }

  // Motion set by a program has no length. A scene that was loaded to stand still may still list
  // animations.
  timeline.there = !scene.motion.empty() && timeline.length > 0;
  timeline.playing = timeline.there && !instant.seconds;
  if (timeline.animations.size() == 1) timeline.animations.clear();
  return timeline;
}

}  // namespace whit::view
