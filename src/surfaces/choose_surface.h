// Chooses among coplanar triangles (bake/coplanar_triangles.h) and coincident spheres that a ray
// hits in one place. Rounding decides which of them is nearest. The rule depends only on the scene
// and the ray's line, so that every mode, packet width and order of rays finds the same surface.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "surfaces/intersect.h"

namespace whit {

// One of the surfaces that the ray hits in one place.
struct SurfaceHit {
  Candidate candidate;
  TriangleHit hit;
  std::uint32_t medium = 0;  // 0 if the surface is no dielectric
  bool entering = false;     // the ray hits the outside
  bool opaque = true;
  std::uint32_t rank = 0;  // position in the order of the scene
};

// Returns all triangles that the ray pierces in the place of `found`, the one of `found` included,
// but not where alpha masks have holes. Neighbors whose common edge the ray passes count as one.
// None where `found` shares its place with nothing, or where the ray misses all of them by
// rounding.
std::vector<SurfaceHit> coplanarHits(const Scene& scene, EffectSet effects, const Ray& ray,
                                     const Candidate& found);

struct ChosenSurface {
  Candidate candidate;
  std::optional<TriangleHit> hit;  // set where other triangles lie in the same place
  std::uint32_t alsoCrossed = 0;   // dielectrics whose faces lie there too (HitColumns)
};

// An opaque surface comes first, then a sheet, then the dielectric of highest priority. Without an
// opaque one, light crosses all other dielectrics in the same place as well. Among equals the last
// one in the scene as it was written comes first, as new paint lies on older paint.
ChosenSurface chooseSurface(const Scene& scene, EffectSet effects, const Ray& ray,
                            const Candidate& found);

// Chooses among coincident spheres by the same rule. A sphere does not count where its mask cuts it
// away.
Candidate chooseSphere(const Scene& scene, EffectSet effects, const Candidate& found);

}  // namespace whit
