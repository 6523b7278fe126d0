// Chooses among coplanar triangles (bake/coplanar_triangles.h) and coincident spheres that a ray
// hits at the same point, where rounding would decide which of them is nearest. The rule depends
// only on the scene and the ray's line, so that every mode, packet width and order of rays finds
// the same surface.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "surfaces/intersect.h"

namespace whit {

// One of the surfaces that the ray hits at the same point.
struct SurfaceHit {
  Candidate candidate;
  TriangleHit hit;
  std::uint32_t medium = 0;  // 0 if the surface is no dielectric
  bool entering = false;     // the ray hits the outside
  bool opaque = true;
  std::uint32_t rank = 0;  // position in the order of the scene as it was written
};

// Returns the triangles that the ray hits at the point of `found`, including that of `found`.
// Triangles that the ray passes there, through a hole of the alpha mask or from the back of a
// single-sided surface, are left out. Neighbors count as one if the ray hits their common edge or
// corner. The result is empty if no triangle overlaps that of `found` there, or if rounding lets
// the ray miss all that do.
std::vector<SurfaceHit> coplanarHits(const Scene& scene, EffectSet effects, const Ray& ray,
                                     const Candidate& found);

struct ChosenSurface {
  Candidate candidate;
  std::optional<TriangleHit> hit;  // set if coplanarHits() found any
  std::uint32_t alsoCrossed = 0;   // as in HitColumns: dielectrics whose faces lie there too
};

// Chooses the surface that light hits at the point of `found`. An opaque surface comes first, then
// a sheet, which is a transparent surface that bounds no medium, then the dielectric of highest
// priority. Among equals the one that was written last in the scene comes first, as new paint lies
// on older paint. If no surface there is opaque, light crosses all other dielectrics there as well.
ChosenSurface chooseSurface(const Scene& scene, EffectSet effects, const Ray& ray,
                            const Candidate& found);

// Chooses among coincident spheres by the same rule. A sphere does not count where its mask cuts it
// away, unless it is that of `found`.
Candidate chooseSphere(const Scene& scene, EffectSet effects, const Candidate& found);

}  // namespace whit
