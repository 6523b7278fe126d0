// The two rays that a surfel can send on: mirrored and refracted (Whitted 1980, "An improved
// illumination model for shaded display").
#pragma once

#include "core/shading_choices.h"
#include "reference/media.h"
#include "reference/surfel.h"

namespace whit::reference {

// A ray whose radiance, times `weight`, is part of the surfel's. No ray: weight 0.
struct Impulse {
  RgbD weight;
  Ray ray;  // unit direction
  MediaStack media = 0;
};

struct Impulses {
  Impulse reflected, refracted;
};

// `stack` is that of the incoming ray, `crossing` what it makes of the surfel. A hidden surface
// lets the ray pass as it is.
Impulses findImpulses(const Scene& scene, EffectSet effects, const Surfel& surfel,
                      const Crossing& crossing, MediaStack stack,
                      const ShadingChoices& choices = {});

// A reflected direction stays at least this far, as a sine, above the surface, and a refracted one
// below: shading normals would send some through to the wrong side (hard case H32). Less than the
// viewer's own elevation, so that reflections are left alone where the normals agree; of refracted
// rays, those are moved that leave a dense medium within 0.6 degrees of the surface.
double smallestElevation(const Surfel& surfel);
// The unit direction `r` raised to `elevation` above the plane of `normal` if it lies lower.
Vec3d lifted(const Vec3d& r, const Vec3d& normal, double elevation);

}  // namespace whit::reference
