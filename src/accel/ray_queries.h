// Ray queries for programs that need hits and no picture. Embree finds what each ray may hit, in
// triangles that are enlarged by its rounding errors; double precision then decides with error
// bounds, and each answer is either certain or marked as uncertain. An answer depends on its ray
// alone: not on the rays beside it, the threads or the processor. There is one exception: at the
// border of a surface that is seen at less than a sixteenth of its area, a hit within the rounding
// of single precision may be missed.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "bake/scene.h"
#include "core/progress.h"
#include "stages/columns.h"

namespace whit {

// Hits count from tNear to tFar, both included, in lengths of the direction.
struct QueryRay {
  Vec3d origin, direction;
  double tNear = 0, tFar = kInfinity;
};

struct QueryHit {
  double t = kInfinity;
  double tError = 0;  // bound on the error of t
  double u = 0, v = 0;
  PlacedTriangleId id{kMiss, kNoInstance};
  bool back = false;  // the side that the corners run around clockwise
  bool certain = true;
  bool found() const { return id.triangle != kMiss; }
};

struct Blocked {
  bool blocked = false, certain = true;
};

class QueryScene;  // no other folder sees Embree

class RayQueries {
 public:
  // The scene must outlive this, and stay as it is. Throws as Accel's constructor.
  RayQueries(const Scene& scene, int threads, Progress* progress);
  ~RayQueries();
  RayQueries(const RayQueries&) = delete;
  RayQueries& operator=(const RayQueries&) = delete;

  // Surfaces count as the eye sees them: alpha masks cut them, rays pass single-sided ones from
  // behind, and only one of several coincident surfaces is hit, as in pictures. Several threads may
  // call these functions at once.
  void closest(std::span<const QueryRay> rays, QueryHit* hits) const;
  // A ray is blocked if closest() finds a hit.
  void blocked(std::span<const QueryRay> rays, Blocked* answers) const;
  // Appends the first `limit` hits of each ray to `hits`, sorted by distance, and writes their
  // number to `counts`.
  void all(std::span<const QueryRay> rays, std::size_t limit, std::vector<QueryHit>& hits,
           std::size_t* counts) const;

 private:
  std::unique_ptr<const QueryScene> scene_;
};

}  // namespace whit
