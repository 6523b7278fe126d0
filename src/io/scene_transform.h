// Transforms and repetitions of a scene file.
#pragma once

#include <vector>

#include "core/affine.h"
#include "io/json_reader.h"

namespace whit {

inline constexpr int kRepeatLimit = 10'000'000;  // copies made by one "repeat"

// {"translate", "rotate", "scale"} (scale first, translate last), {"matrix": 12 numbers, row-major
// 3x4}, or a list of those, the first applied first. Fails for maps that flatten space.
Affine readTransform(const JsonValue& value);

// Where the copies of an item stand in its parent: "transform", then moved by multiples of the step
// of "repeat". At least one.
std::vector<Affine> readPlacements(JsonObject& item);

}  // namespace whit
