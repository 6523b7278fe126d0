// How bright a scene's lights are.
#pragma once

#include "scene/description.h"

namespace whit {

// The mean brightness of white surfaces that the lights reach, shadows left out: the mean, over
// their area, of the logarithm of irradiance / pi. 0 where no light reaches any.
double lightLevel(const SceneDescription& scene);

}  // namespace whit
