// Steps after findHits, in scenes with coplanar triangles that overlap or with coincident spheres.
#pragma once

#include <vector>

#include "accel/accel.h"
#include "stages/chunk.h"

namespace whit {

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

}  // namespace whit
