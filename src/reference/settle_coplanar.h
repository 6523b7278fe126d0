// Chooses among coplanar triangles that a ray hits in one place (bake/coplanar_triangles.h).
// Rounding decides which of them is nearest. The rule depends only on the scene and the ray's line,
// so that every mode, packet width and order of rays finds the same triangle.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "reference/intersect.h"
#include "reference/intersector.h"

namespace whit::reference {

// One of the triangles at the place.
struct Place {
  Candidate candidate;
  TriangleHit hit;
  std::uint32_t medium = 0;  // of dielectrics
  bool entering = false;     // its outside is hit
  bool opaque = true;
  std::uint32_t rank = 0;  // in the order of the scene
};

// All surfaces that the ray pierces there, that of `met` included, holes of alpha masks left out;
// of neighbors whose common edge it passes one. None where `met` shares its place with nothing, or
// where rounding has it that the ray passes beside all of them.
std::vector<Place> placesAt(const Scene& scene, EffectSet effects, const Ray& ray,
                            const Candidate& met);

struct Settled {
  Candidate candidate;
  std::optional<TriangleHit> hit;  // where other triangles lie in the same place
  std::uint32_t alsoCrossed = 0;   // dielectrics whose faces lie there too (reference/media.h)
};

// Light meets the opaque surface; of dielectrics alone the one of highest priority, and with it all
// the others are crossed; of equals the last in the scene as it was written, as paint lies on what
// was painted before.
Settled settleCoplanar(const Scene& scene, EffectSet effects, const Ray& ray, const Candidate& met);

// Chooses among coincident spheres by the rule for coplanar triangles: an opaque sphere comes
// first, then a sheet, then the dielectric of highest priority, and of equals the last in the
// scene. A sphere does not count where its mask cuts it away.
Candidate settleSpheres(const Scene& scene, EffectSet effects, const Candidate& met);

}  // namespace whit::reference
