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

// One of the coplanar triangles that the ray hits.
struct Place {
  Candidate candidate;
  TriangleHit hit;
  std::uint32_t medium = 0;  // 0 if the surface is no dielectric
  bool entering = false;     // the ray hits the outside
  bool opaque = true;
  std::uint32_t rank = 0;  // position in the order of the scene
};

// Returns all surfaces that the ray pierces in the place of `met`, the one of `met` included, but
// not where alpha masks have holes. Neighbors whose common edge the ray passes count as one. None
// where `met` shares its place with nothing, or where the ray misses all of them by rounding.
std::vector<Place> placesAt(const Scene& scene, EffectSet effects, const Ray& ray,
                            const Candidate& met);

struct Settled {
  Candidate candidate;
  std::optional<TriangleHit> hit;  // set where other triangles lie in the same place
  std::uint32_t alsoCrossed = 0;   // dielectrics whose faces lie there too (reference/media.h)
};

// An opaque surface comes first, then a sheet, then the dielectric of highest priority. Without an
// opaque one, light crosses all other dielectrics in the same place as well. Among equals the last
// one in the scene as it was written comes first, as new paint lies on older paint.
Settled settleCoplanar(const Scene& scene, EffectSet effects, const Ray& ray, const Candidate& met);

// Chooses among coincident spheres by the rule for coplanar triangles: an opaque sphere comes
// first, then a sheet, then the dielectric of highest priority, and of equals the last in the
// scene. A sphere does not count where its mask cuts it away.
Candidate settleSpheres(const Scene& scene, EffectSet effects, const Candidate& met);

}  // namespace whit::reference
