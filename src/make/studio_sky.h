// The sky of a photographer's studio, for models without an environment of their own.
#pragma once

#include "scene/light.h"

namespace whit {

inline constexpr const char* kStudio = "studio";

// A gray gradient with three soft boxes, which lie above the part that is visible beside a model.
Sky studioSky();

}  // namespace whit
