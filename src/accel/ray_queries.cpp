#include "accel/ray_queries.h"

#include <algorithm>

#include "accel/query_batch.h"
#include "accel/query_scene.h"
#include "core/index.h"

namespace whit {

namespace {

// Calls visit(batch, ray of the batch, ray) for each ray when it has been traced.
template <typename Visitor>
void forEachRay(const QueryScene& scene, QueryKind kind, std::span<const QueryRay> rays,
                const Visitor& visit) {
  RayBatch batch(scene, kind);
  for (std::size_t begin = 0; begin < rays.size(); begin += RayBatch::kRays) {
    const std::size_t n = std::min(RayBatch::kRays, rays.size() - begin);
    batch.trace(rays.subspan(begin, n));
    for (const auto i : indices(n)) visit(batch, i, begin + i);
  }
}

}  // namespace

RayQueries::RayQueries(const Scene& scene, int threads, Progress* progress)
    : scene_(std::make_unique<QueryScene>(scene, threads, progress)) {}
RayQueries::~RayQueries() = default;

void RayQueries::closest(std::span<const QueryRay> rays, QueryHit* hits) const {
  forEachRay(
      *scene_, QueryKind::closest, rays, [&](RayBatch& batch, std::size_t i, std::size_t ray) {
        hits[ray] = batch.hasOthers() ? scene_->exact().nearestOf(batch.hits(i)) : batch.best(i);
        hits[ray].certain = hits[ray].certain && batch.answer(i).certain;
      });
}

void RayQueries::blocked(std::span<const QueryRay> rays, Blocked* answers) const {
  forEachRay(*scene_, QueryKind::any, rays, [&](RayBatch& batch, std::size_t i, std::size_t ray) {
    answers[ray] = batch.answer(i);
  });
}

void RayQueries::all(std::span<const QueryRay> rays, std::size_t limit, std::vector<QueryHit>& hits,
                     std::size_t* counts) const {
  forEachRay(*scene_, QueryKind::all, rays, [&](RayBatch& batch, std::size_t i, std::size_t ray) {
    std::vector<QueryHit>& found = batch.hits(i);
    scene_->exact().keepDistinct(found);
    counts[ray] = std::min(found.size(), limit);
    for (const auto k : indices(counts[ray])) {
      hits.push_back(found[k]);
      hits.back().certain = found[k].certain && batch.answer(i).certain;
    }
  });
}

}  // namespace whit
