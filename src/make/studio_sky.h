// The sky of a photographer's studio, for models without an environment of their own.
#pragma once

#include "scene/light.h"

namespace whit {

inline constexpr const char* kStudio = "studio";

// Returns a gray gradient with three soft boxes, which lie above the part of the sky that is
// visible beside a model.
Sky studioSky();

}  // namespace whit
