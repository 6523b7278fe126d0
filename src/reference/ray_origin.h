// Where rays leave a surfel.
#pragma once

#include "core/shading_choices.h"
#include "reference/surfel.h"

namespace whit::reference {

// `side` is 1 for the viewer's side of the surface, -1 for the other. Waechter and Binder's method
// is one on the bits of floats: the position is rounded to float for it.
Vec3d rayOrigin(OffsetMethod method, const Surfel& surfel, double side);

}  // namespace whit::reference
