// The soft shadow of a model on the ground that it stands on.
#pragma once

#include "scene/description.h"

namespace whit {

// Adds a black sheet just below the model, which covers what is behind it as far as the model holds
// off light of the sky there: the share of the directions above a plane, weighted by their cosine,
// in which the model stands. So it is the same before any background, and transparent pictures have
// it in their alpha. The sheet is seen from above, casts no shadow, and keeps the shadow of the
// scene's time while the model moves.
void addGroundShadow(SceneDescription& scene);

}  // namespace whit
