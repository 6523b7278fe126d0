// Answers for programs that ask what rays hit and want no picture. Embree finds what each ray may
// hit, in triangles that are larger by its rounding errors; double precision then decides with
// error bounds, and an answer is either certain or says that it is not. It depends on its ray
// alone: not on the rays beside it, the threads or the processor. One thing is beyond this: a
// border of a surface that is seen at less than a sixteenth of its area may be passed where a ray
// meets it within the rounding of single precision.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
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
  double tNear = 0, tFar = std::numeric_limits<double>::infinity();
};

struct QueryHit {
  double t = std::numeric_limits<double>::infinity();
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

class RayQueries {
 public:
  // The scene must outlive this, and stay as it is. Throws as Accel's constructor.
  RayQueries(const Scene& scene, int threads, Progress* progress);
  ~RayQueries();
  RayQueries(const RayQueries&) = delete;
  RayQueries& operator=(const RayQueries&) = delete;

  // Surfaces count as the eye sees them: alpha masks cut them, single-sided ones are passed from
  // behind, and of surfaces in one place one is hit, as in pictures. Threads may ask at once.
  void closest(std::span<const QueryRay> rays, QueryHit* hits) const;
  // A ray is blocked if closest() finds anything.
  void blocked(std::span<const QueryRay> rays, Blocked* answers) const;
  // Appends the first `limit` hits of each ray to `hits`, by their distance, and writes how many
  // they are.
  void all(std::span<const QueryRay> rays, std::size_t limit, std::vector<QueryHit>& hits,
           std::size_t* counts) const;

  struct Parts;  // ray_queries.cpp; no other folder sees Embree

 private:
  std::unique_ptr<Parts> parts_;
};

}  // namespace whit
