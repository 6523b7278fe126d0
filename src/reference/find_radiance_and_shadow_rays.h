// findRadianceAndShadowRays: what a surfel sends to the viewer from one light, and the ray that
// asks whether something is in between.
#pragma once

#include <optional>

#include "core/shading_choices.h"
#include "reference/world.h"
#include "sampling/random_streams.h"

namespace whit::reference {

// The glossy lobe's reflectance density (1/sr) towards the viewer for light from the unit direction
// `toLight`: GGX with height-correlated masking (Walter et al. 2007, "Microfacet models for
// refraction"; Heitz 2014, "Understanding the masking-shadowing function"), Fresnel after Schlick,
// fading out for reflectances below 4 %, which no real surface has (Lagarde and de Rousiers 2014,
// "Moving Frostbite to PBR", section 3.1).
RgbD glossyLobe(const Surfel& surfel, const Vec3d& toLight);

// Chooses a point of a light that has a radius: the one at `at` of the light as the surfel sees the
// light, where (u, v) run evenly over the solid angle (Shirley, Wang and Zimmerman 1996, "Monte
// Carlo techniques for direct lighting calculations", section 3.2). The shadow ray ends on the
// sphere. A surfel inside the sphere is lit from the center.
struct LightPoint {
  bool center = true;
  UnitPoint at;
};

struct LightArrival {
  RgbD radiance;    // towards the viewer if nothing is in between, as if the whole light were at
                    // that point; 0 needs no shadow ray
  Ray shadowRay;    // reaches from the surfel to the light, not normalized
  double tFar = 0;  // a little before the light; infinite if the light is directional
};

LightArrival radianceFromLight(EffectSet effects, const Surfel& surfel, const Light& light,
                               const ShadingChoices& choices = {}, const LightPoint& point = {});

// Returns the same as radianceFromLight(), in scenes with fog dimmed by the fog on the way from the
// light.
LightArrival arrivalFromLight(const Scene& scene, EffectSet effects, const Surfel& surfel,
                              const Light& light, const ShadingChoices& choices,
                              const LightPoint& point);

// Returns the arrival of ambient light, as if all of it came from the direction drawn by the cosine
// to the shading normal at `at`. It is occluded by anything nearer than the occlusion radius and by
// the surface itself. Nothing arrives where the surfel reflects none.
LightArrival ambientArrival(const Scene& scene, EffectSet effects, const Surfel& surfel,
                            const ShadingChoices& choices, const UnitPoint& at);

// Returns the arrival at the chunk's slot from the current point of its light.
LightArrival arrivalAt(const World& world, const Chunk& chunk, std::size_t slot);

// Return the rows that the step writes for a slot that the light reaches and for a shadow ray. None
// where in double the light lies in the surface's plane, or behind it.
std::optional<UnshadowedRow> findRadiance(const World& world, const Chunk& chunk, std::size_t slot);
std::optional<ShadowRow> findShadowRay(const World& world, const Chunk& chunk,
                                       std::size_t shadowRay);

}  // namespace whit::reference
