// Which dielectrics rays start inside of: for eyes under water.
#pragma once

#include "reference/intersector.h"
#include "reference/media.h"

namespace whit::reference {

// The media whose surfaces a ray from the point leaves without having entered them first, the one
// left first in the low byte; at most four (hard case H47). However many opaque surfaces lie in
// between: they bound no medium. 0 without Effect::transmission.
MediaStack initialMediumStack(const Scene& scene, EffectSet effects, const Intersector& intersector,
                              const Vec3d& point);

// True if the point lies in the surface of a dielectric: rays that start there are in one medium or
// the other, each by its direction.
bool liesOnDielectric(const Scene& scene, EffectSet effects, const Intersector& intersector,
                      const Vec3d& point);

// The camera for a picture of that size, and the media around it.
CameraFrame frameWithMedia(const Scene& scene, EffectSet effects, const Intersector& intersector,
                           const Camera& camera, int width, int height);

// Around the start of a ray of the camera, just past what the eye lies in.
MediaStack mediaAtStart(const Scene& scene, EffectSet effects, const Intersector& intersector,
                        const CameraFrame& camera, const Ray& ray);

}  // namespace whit::reference
