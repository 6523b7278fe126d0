// Which dielectrics a point is inside of: for eyes under water.
#pragma once

#include "reference/intersector.h"
#include "reference/media.h"

namespace whit::reference {

// The media whose surfaces a ray from the point leaves without having entered them first, the one
// left first in the low byte; at most four (hard case H47). 0 without Effect::transmission.
MediaStack initialMediumStack(const Scene& scene, EffectSet effects, const Intersector& intersector,
                              const Vec3d& point);

}  // namespace whit::reference
