// "motion" in scene files: how an item, a camera or a light moves.
#pragma once

#include <memory>
#include <string>

#include "io/json_reader.h"
#include "scene/description.h"
#include "scene/rig.h"

namespace whit {

// The member "motion" of `object`: where it takes what it moves, in the space that this stands in,
// after its other transforms; null where there is none. {"keys": [{"time", "translate", "rotate",
// "scale"}, ...], "interpolation": "linear" | "step" | "cubic", "loop": true}; scale comes first,
// translate last. "rotate" is [x, y, z, degrees], the axis the same in all keys. Cubic goes
// smoothly through the keys (Catmull and Rom 1974). Counts as the scene's animation kSceneMotion.
// A thing that is moved by hand always has a motion. Throws badScene with the place.
std::shared_ptr<const Motion> readMotion(JsonObject& object, const Instant& instant,
                                         SceneDescription& scene);

// The pointer to an object of which that motion was read, where it is moved by hand; empty else.
std::string movableName(const JsonObject& object, const Instant& instant);

}  // namespace whit
