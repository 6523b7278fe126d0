// Hits on triangles and spheres in double precision. Each hit has bounds on its errors, and is
// either certain or marked as uncertain.
#pragma once

#include <optional>
#include <vector>

#include "accel/alpha_filter.h"
#include "accel/ray_queries.h"

namespace whit {

class ExactIntersector {
 public:
  explicit ExactIntersector(const Scene& scene)
      : scene_(scene), masks_(makeMasks(scene, EffectSet::all())) {}

  std::optional<QueryHit> hitTriangle(const QueryRay& ray, PlacedTriangleId id) const;
  // Returns the number of hits.
  int hitSphere(const QueryRay& ray, PlacedTriangleId id, QueryHit (&hits)[2]) const;

  // The nearest of a ray's hits, which get sorted. It is uncertain where another surface may be as
  // near.
  QueryHit nearestOf(std::vector<QueryHit>& hits) const;
  // Sorts the hits and leaves one of those that are on coincident surfaces or on a shared edge.
  void keepDistinct(std::vector<QueryHit>& hits) const;

  const Mask& maskOf(std::uint32_t triangle) const {
    return masks_[scene_.triangles[triangle].material];
  }

 private:
  bool areCoincident(PlacedTriangleId a, PlacedTriangleId b) const;
  bool comesBefore(PlacedTriangleId a, PlacedTriangleId b) const;
  bool areNeighbors(const QueryHit& a, const QueryHit& b) const;

  const Scene& scene_;
  std::vector<Mask> masks_;
};

}  // namespace whit
