// Nested dielectrics: which media a ray is inside of, for eyes under water from its start on, and
// which of them counts.
#pragma once

#include <cstdint>

#include "bake/scene.h"
#include "reference/intersector.h"

namespace whit::reference {

// The media a ray is inside of, by their numbers in Scene::media, a byte each; the one entered last
// in the low byte, 0 where there is none. Four fit; a fifth pushes the oldest out.
using MediaStack = std::uint32_t;

MediaStack pushMedium(MediaStack stack, std::uint32_t medium);

// Returns the stack without the occurrence of `medium` that was entered last; unchanged if there is
// none, because the ray started inside.
MediaStack removeMedium(MediaStack stack, std::uint32_t medium);

// Returns the medium that fills the space: the one of highest priority, among equals the one
// entered last; the vacuum, 0, outside everything (Schmidt and Budge 2002, "Simple nested
// dielectrics in ray traced images").
std::uint32_t currentMedium(const Scene& scene, MediaStack stack);

// Adds a dielectric to `others`, those whose faces share the place of the crossed one, packed as in
// hits (stages/columns.h). Three fit.
std::uint32_t withCrossing(std::uint32_t others, std::uint32_t medium, bool entering);

// A ray crosses the surface of a dielectric, and those of `others` with it.
struct Crossing {
  bool dielectric = false;
  bool hidden = false;         // the same medium on both sides: the surface is not there
  double n1 = 1, n2 = 1;       // refractive indices in front and behind
  MediaStack stackBehind = 0;  // of a refracted ray
};
Crossing crossMedia(const Scene& scene, EffectSet effects, std::uint32_t material, bool entering,
                    MediaStack stack, std::uint32_t others = 0);

// Beer's law: what is left of each channel after `distance` in the current medium; an infinite
// distance leaves nothing of the channels that are absorbed at all.
RgbD transmittance(const Scene& scene, MediaStack stack, double distance);

// Returns the camera for a picture of this size and number of samples per pixel, with the media
// around the eye.
CameraFrame frameWithMedia(const Scene& scene, EffectSet effects, const Intersector& intersector,
                           const Camera& camera, int width, int height, int samples);

// Returns the media around the start of a camera ray, just past the surface that the eye lies in.
MediaStack mediaAtStart(const Scene& scene, EffectSet effects, const Intersector& intersector,
                        const CameraFrame& camera, const Ray& ray);

}  // namespace whit::reference
