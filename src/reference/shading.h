// What a surfel sends to the viewer by itself and from the lights.
#pragma once

#include "core/shading_choices.h"
#include "reference/surfel.h"

namespace whit::reference {

// Radiance of the sky along the unit direction, black where the effects leave it out.
RgbD skyAlong(const Scene& scene, EffectSet effects, const Vec3d& direction);

// Emission, and the ambient light reflected by the diffuse color.
RgbD emittedAndAmbient(const Scene& scene, EffectSet effects, const Surfel& surfel);

// The glossy lobe's reflectance density (1/sr) towards the viewer for light from the unit direction
// `toLight`: GGX with height-correlated masking (Walter et al. 2007, "Microfacet models for
// refraction"; Heitz 2014, "Understanding the masking-shadowing function"), Fresnel after Schlick,
// fading out for reflectances below 4 %, which no real surface has (Lagarde and de Rousiers 2014,
// "Moving Frostbite to PBR", section 3.1).
RgbD glossyLobe(const Surfel& surfel, const Vec3d& toLight);

struct LightArrival {
  RgbD radiance;    // towards the viewer if nothing is in between; all 0: no need to look
  Ray shadowRay;    // from the surfel to the light, not normalized
  double tFar = 0;  // a little before the light; infinite where it is directional
};
LightArrival radianceFromLight(EffectSet effects, const Surfel& surfel, const Light& light,
                               const ShadingChoices& choices = {});

}  // namespace whit::reference
