// The dielectrics that rays start inside of, for eyes under water.
#pragma once

#include <cstdint>

#include "bake/scene.h"
#include "surfaces/intersector.h"

namespace whit {

// The media a ray is inside of, by their numbers in Scene::media, a byte each; the one entered last
// in the low byte, 0 where there is none. Four fit; a fifth pushes the oldest out.
using MediaStack = std::uint32_t;

// Returns the camera for a picture of this size and number of samples per pixel, with the media
// around the eye.
CameraFrame frameWithMedia(const Scene& scene, EffectSet effects, const Intersector& intersector,
                           const Camera& camera, int width, int height, int samples);

// Returns the media around the start of a camera ray, just past the surface that the eye lies in.
MediaStack mediaAtStart(const Scene& scene, EffectSet effects, const Intersector& intersector,
                        const CameraFrame& camera, const Ray& ray);

}  // namespace whit
