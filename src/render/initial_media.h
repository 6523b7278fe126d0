// The dielectrics that primary rays start inside of. All rays of a perspective camera start in one
// point, which may lie on the surface of a dielectric; those of a parallel camera start all over a
// rectangle, through which such a surface may cut. Then each ray starts in media of its own. The
// scalar reference has an implementation of its own (reference/initial_medium_stack.h).
#pragma once

#include "core/box.h"
#include "core/image.h"
#include "render/settle_coplanar.h"
#include "scene/camera.h"
#include "stages/chunk.h"

namespace whit {

// A box around all surfaces of dielectrics, instances included; empty without any.
Box dielectricBounds(const Scene& scene);

// The camera for an image of that size, and the media around it; `dielectrics` are the bounds
// above.
CameraFrame frameWithMedia(const TracedScene& traced, Camera camera, const Image& image,
                           const Box& dielectrics);

// A step after generateRays: the media of each ray, where they vary.
void findInitialMedia(Chunk& c);

}  // namespace whit
