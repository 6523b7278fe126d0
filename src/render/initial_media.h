// The dielectrics that primary rays start inside of. All rays of a perspective camera start in one
// point; those of a parallel camera start all over a rectangle, each in media of its own where the
// surface of a dielectric cuts through it.
#pragma once

#include "core/box.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "stages/chunk.h"

namespace whit {

// A box around all surfaces of dielectrics, instances included; empty without any.
Box dielectricBounds(const Scene& scene);

// Whether rays of the camera may start in different media. Conservative: it compares boxes.
bool mediaVary(const CameraFrame& camera, const Box& dielectrics);

// A step after generateRays: the media of each ray, where they vary.
void findInitialMedia(Chunk& c);

}  // namespace whit
