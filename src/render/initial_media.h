// The dielectrics that primary rays start inside of. All rays of a perspective camera start in one
// point, which may lie on the surface of a dielectric; those of a parallel camera start all over a
// rectangle, through which such a surface may cut. Then each ray starts in media of its own.
#pragma once

#include "bake/scene.h"
#include "core/box.h"
#include "scene/camera.h"
#include "stages/chunk.h"

namespace whit {

// A box around all surfaces of dielectrics, instances included; empty without any.
Box dielectricBounds(const Scene& scene);

// True if rays that start at different points, all in the plane through the eye, may start in
// different media. The test is conservative because it compares boxes.
bool startsMeet(const CameraFrame& camera, const Box& dielectrics);

// A step after generateRays: the media of each ray, where they vary.
void findInitialMedia(Chunk& c);

}  // namespace whit
