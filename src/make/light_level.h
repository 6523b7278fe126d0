// How bright the lights of a model are.
#pragma once

#include "scene/description.h"

namespace whit {

// The mean brightness of white surfaces that the lights reach, without shadows: the mean, over
// their area, of the logarithm of irradiance / pi. It is 0 where no light reaches any.
double lightLevel(const SceneDescription& scene);

}  // namespace whit
