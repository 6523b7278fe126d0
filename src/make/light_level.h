// How bright the lights of a model are.
#pragma once

#include "scene/description.h"

namespace whit {

// Returns the mean brightness of white surfaces that the lights reach, without shadows: the
// geometric mean of irradiance / pi over their area. It is 0 if no light reaches any surface.
double lightLevel(const SceneDescription& scene);

}  // namespace whit
