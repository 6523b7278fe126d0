#include "render/settle_flush.h"

#include <algorithm>

#include "reference/settle_flush.h"
#include "reference/twin.h"

namespace whit {

void settleFlush(Chunk& c) {
  const Scene& scene = *c.frame->scene;
  std::fill_n(c.hits.alsoCrossed, c.n, 0u);
  const bool instanced = c.has(Feature::instances);
  for (std::size_t i = 0; i < c.n; ++i) {
    if (!scene.flush.any(c.hits.triangle[i])) continue;
    const PlacedTriangleId met{c.hits.triangle[i], instanced ? c.hits.instance[i] : kNoInstance};
    if (!scene.flush.anyAt(met, double{c.hits.u[i]}, double{c.hits.v[i]})) continue;
    const reference::Settled settled = reference::settleFlush(
        scene, c.frame->effects, reference::rayOf(c, i), reference::candidateOf(c, i));
    if (!settled.flush) continue;
    c.hits.triangle[i] = settled.candidate.triangle;
    if (instanced) c.hits.instance[i] = settled.candidate.instance;
    c.hits.t[i] = static_cast<float>(settled.hit.t);
    c.hits.u[i] = static_cast<float>(settled.hit.u);
    c.hits.v[i] = static_cast<float>(settled.hit.v);
    c.hits.alsoCrossed[i] = settled.alsoCrossed;
  }
}

}  // namespace whit
