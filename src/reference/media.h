// Nested dielectrics: which media a ray is inside of behind the surfaces that it crosses, and which
// of them counts.
#pragma once

#include <cstdint>

#include "bake/scene.h"
#include "surfaces/initial_media.h"

namespace whit::reference {

MediaStack pushMedium(MediaStack stack, std::uint32_t medium);

// Returns the stack without the occurrence of `medium` that was entered last; unchanged if there is
// none, because the ray started inside.
MediaStack removeMedium(MediaStack stack, std::uint32_t medium);

// Returns the medium that fills the space: the one of highest priority, among equals the one
// entered last; the vacuum, 0, outside everything (Schmidt and Budge 2002, "Simple nested
// dielectrics in ray traced images").
std::uint32_t currentMedium(const Scene& scene, MediaStack stack);

// A ray crosses the surface of a dielectric, and those of `others` with it.
struct Crossing {
  bool dielectric = false;
  bool hidden = false;         // the same medium on both sides: the surface is not there
  double n1 = 1, n2 = 1;       // refractive indices in front and behind
  MediaStack stackBehind = 0;  // stack of a refracted ray
};
Crossing crossMedia(const Scene& scene, EffectSet effects, std::uint32_t material, bool entering,
                    MediaStack stack, std::uint32_t others = 0);

// Beer's law: what is left of each channel after `distance` in the current medium; an infinite
// distance leaves nothing of the channels that are absorbed at all.
RgbD transmittance(const Scene& scene, MediaStack stack, double distance);

}  // namespace whit::reference
