// Steps of a plan that are no kernels, besides those of accel/accel.h.
#pragma once

#include <vector>

#include "accel/accel.h"
#include "core/image.h"
#include "core/vec3.h"
#include "scene/camera.h"
#include "stages/chunk.h"

namespace whit {

// Replaces decideShadows (--shadow-cache audit): it does the same, traces every ray that was
// decided, and stores the first ray that contradicts the cache in the chunk's meter.
void auditShadows(Chunk& c);

// Rounds radiance to what the film keeps (--film), encodes it where display codes are wanted, and
// writes both to the pixels.
void updateImage(Chunk& c);

// Display codes of the chunk's radiance, as --exposure, --tonemap and --srgb say.
void encodeForDisplay(Chunk& c);

// Pixels of the chunk that are not finite.
std::uint64_t countNonFinite(const Chunk& c);

// Stores all channels of the surfels of depth 0 except the ray counts.
void keepChannels(Chunk& c);

// Rays are counted where they are traced, and the counts follow the way of the radiance: each ray
// is one, with its shadow rays and all that its children bring back.
void countRays(Chunk& c);
void countShadowRays(Chunk& c);  // of the light in hand
void returnRayCounts(Chunk& c);  // to the parents
void keepRayCounts(Chunk& c);

// Steps after findHits, in scenes with coplanar triangles that overlap or with coincident spheres.

// A scene as the steps of a plan trace it.
struct TracedScene {
  const Scene& scene;
  const Accel& accel;
  EffectSet effects;  // of the plan
};

struct Line {
  Vec3d origin, direction;
};

struct LineHit {
  double t = 0, u = 0, v = 0;
};

// A triangle that the ray hits, and what it is to the rule.
struct CoplanarFace {
  PlacedTriangleId id;
  LineHit hit;
  double nearest = 0, farthest = 0;  // bounds of the distance t, which was computed from floats
  std::uint32_t rank = 0, medium = 0;
  bool opaque = true, entering = false;
};

// The faces that the ray hits in the place of the triangle that Embree has found, that one
// included, in the order of the scene. Empty if no other triangle lies there.
std::vector<CoplanarFace> coplanarFaces(const TracedScene& traced, const Line& ray,
                                        PlacedTriangleId found, double u, double v);

// Chooses among the coplanar triangles that a ray hits in one place. Rounding decides which of them
// Embree reports, so the choice depends on the scene and the ray's line alone: an opaque surface
// comes first, then a sheet, then the dielectric of highest priority, and of equals the last in the
// scene. Where a dielectric is chosen, `alsoCrossed` lists the other dielectrics that the ray
// crosses there. The scalar reference has an implementation of its own
// (reference/settle_coplanar.h).
void settleCoplanar(Chunk& c);

struct SphereHit {
  PlacedTriangleId id;
  double u = 0, v = 0;
};

// The one of coincident exact spheres that counts where Embree has found one of them, by the same
// rule. The others are as if they were not there.
SphereHit chosenSphere(const TracedScene& traced, const SphereHit& found);
void settleSpheres(Chunk& c);

// The dielectrics that primary rays start inside of. All rays of a perspective camera start in one
// point, which may lie on the surface of a dielectric; those of a parallel camera start all over a
// rectangle, through which such a surface may cut. Then each ray starts in media of its own. The
// scalar reference has an implementation of its own (reference/media.h).

// A box around all surfaces of dielectrics, instances included; empty without any.
Box dielectricBounds(const Scene& scene);

// The camera for an image of that size, and the media around it; `dielectrics` are the bounds
// above.
CameraFrame frameWithMedia(const TracedScene& traced, Camera camera, const Image& image,
                           const Box& dielectrics);

// A step after generateRays: the media of each ray, where they vary.
void findInitialMedia(Chunk& c);

}  // namespace whit
