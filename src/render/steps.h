// Steps of a plan that are no kernels, besides those of accel/accel.h.
#pragma once

#include <cstdint>

#include "bake/scene.h"
#include "core/vec3.h"
#include "scene/camera.h"
#include "stages/chunk.h"

namespace whit {

// Writes radiance to the pixels, and display codes of it where they are wanted.
void updateImage(Chunk& c);

// Display codes of the chunk's radiance, as --exposure and --tonemap say.
void encodeForDisplay(Chunk& c);

// Pixels of the chunk that are not finite.
std::uint64_t countNonFinite(const Chunk& c);

// Bounds the rays of samples (sampling/ray_limit.h), after all steps that write children. The first
// time it counts them and drops those of samples that are given up; when samples are traced again
// it drops what makes their trees too wide.
void limitRays(Chunk& c);

// Stores the channels of ChannelValues (core/channels.h) for the surfels of depth 0: all channels
// but the ray counts, alpha and error.
void keepChannels(Chunk& c);

// Rays are counted where they are traced, and the counts follow the way of the radiance: each ray
// is one, with its shadow rays and all that its children bring back.
void countRays(Chunk& c);
void countShadowRays(Chunk& c);  // the rays to the current light
void returnRayCounts(Chunk& c);  // to the parents
void keepRayCounts(Chunk& c);

// The share of the light that ended paths could bring (RadianceColumns::ended) goes the same way.
void startEnds(Chunk& c);
void returnEnds(Chunk& c);
void keepEnds(Chunk& c);

// The share of the background that is seen straight through surfaces (RadianceColumns::clear) goes
// the same way. The background takes the place of the sky there.
void startAlpha(Chunk& c);
void markStraight(Chunk& c);  // children that go on as their parents
void returnAlpha(Chunk& c);
void keepAlpha(Chunk& c);

// Steps after findHits, in scenes with coplanar triangles that overlap or with coincident spheres.
// They choose among the surfaces that a ray hits in one place, by the rule of
// surfaces/choose_surface.h, and note the dielectrics that the ray crosses there
// (HitColumns::alsoCrossed). The reference follows the same code: few rays need it, and it has to
// be computed in double.
void chooseCoplanar(Chunk& c);
void chooseSpheres(Chunk& c);

// The dielectrics that primary rays start inside of (surfaces/initial_media.h). All rays of a
// perspective camera start in one point, which may lie on the surface of a dielectric; those of a
// parallel camera start all over a rectangle, through which such a surface may cut. Then each ray
// starts in media of its own.

// A box around all surfaces of dielectrics, instances included; empty without any.
Box dielectricBounds(const Scene& scene);

// True if rays that start at different points, all in the plane through the eye, may start in
// different media. The test is conservative because it compares boxes; `dielectrics` are the bounds
// above.
bool startsMayLieInside(const CameraFrame& camera, const Box& dielectrics);

// A step after generateRays: the media of each ray, where they vary.
void findInitialMedia(Chunk& c);

}  // namespace whit
