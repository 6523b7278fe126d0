// Which dielectrics rays start inside of: for eyes under water.
#pragma once

#include "reference/intersector.h"
#include "reference/media.h"

namespace whit::reference {

// The camera for a picture of that size, and the media around it.
CameraFrame frameWithMedia(const Scene& scene, EffectSet effects, const Intersector& intersector,
                           const Camera& camera, int width, int height);

// Around the start of a ray of the camera, just past what the eye lies in.
MediaStack mediaAtStart(const Scene& scene, EffectSet effects, const Intersector& intersector,
                        const CameraFrame& camera, const Ray& ray);

}  // namespace whit::reference
