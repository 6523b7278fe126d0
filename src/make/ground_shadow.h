// The soft shadow of a model on the ground that it stands on.
#pragma once

#include "scene/description.h"

namespace whit {

// Adds a black sheet just below the model. Its opacity is the share of a uniform sky that the model
// occludes there: the share of the directions above a plane, weighted by their cosine, in which the
// model stands. So the shadow is the same before any background, and transparent pictures have it
// in their alpha. The sheet is seen from above and casts no shadow. While the model moves, it keeps
// the shadow of the scene's time.
void addGroundShadow(SceneDescription& scene);

}  // namespace whit
