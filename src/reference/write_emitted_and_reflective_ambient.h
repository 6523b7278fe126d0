// writeEmittedAndReflectiveAmbient: what a ray brings without lights and without further rays.
#pragma once

#include "reference/twin.h"

namespace whit::reference {

// Radiance of the sky along the unit direction, black where the effects leave it out.
RgbD skyAlong(const Scene& scene, EffectSet effects, const Vec3d& direction);

// Ambient light reflected by the diffuse color, of the part of the surface that is there: black
// where that reflects the scene instead.
RgbD reflectedAmbient(const Scene& scene, EffectSet effects, const Surfel& surfel);

// Emission, and ambient light that nothing is looked for to hold off.
RgbD emittedAndAmbient(const Scene& scene, EffectSet effects, const Surfel& surfel);

// The row that the step writes.
RadianceRow writeEmittedAndReflectiveAmbient(const World& world, const Chunk& chunk,
                                             std::size_t slot);

}  // namespace whit::reference
