// Which dielectrics a point is inside of: for eyes under water.
#pragma once

#include "reference/intersector.h"
#include "reference/media.h"

namespace whit::reference {

// The media whose surfaces a ray from the point leaves without having entered them first, the one
// left first in the low byte; at most four (hard case H47). However many opaque surfaces lie in
// between: they bound no medium.
MediaStack initialMediumStack(const Scene& scene, const Intersector& intersector,
                              const Vec3d& point);

// Of the camera's rays: where each starts, or for all of them together.
MediaStack mediaAround(const Scene& scene, EffectSet effects, const Intersector& intersector,
                       const CameraFrame& camera, const Vec3d& start);

}  // namespace whit::reference
