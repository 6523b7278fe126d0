// Steps after findHits, in scenes with coplanar triangles that overlap or with coincident spheres.
#pragma once

#include "stages/chunk.h"

namespace whit {

// Chooses among the coplanar triangles that a ray hits in one place. Rounding decides which of them
// Embree reports, so the choice depends on the scene and the ray's line alone: an opaque surface
// comes first, then a sheet, then the dielectric of highest priority, and of equals the last in the
// scene. Where a dielectric is chosen, `alsoCrossed` lists the other dielectrics that the ray
// crosses there. The scalar reference has an implementation of its own
// (reference/settle_coplanar.h).
void settleCoplanar(Chunk& c);

// The same for coincident spheres. The others are as if they were not there.
void settleSpheres(Chunk& c);

}  // namespace whit
