// The sky of a photographer's studio: for models, which bring nothing to be mirrored.
#pragma once

#include "scene/light.h"

namespace whit {

inline constexpr const char* kStudio = "studio";

// A gray gradient with three soft boxes, all of them above what is seen of it beside a model.
Sky studioSky();

}  // namespace whit
