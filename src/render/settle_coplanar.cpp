#include "reference/settle_coplanar.h"

#include <algorithm>

#include "reference/world.h"
#include "render/steps.h"

namespace whit {

namespace {

void setSurface(const reference::Candidate& chosen, std::size_t i, Chunk& c) {
  c.hits.triangle[i] = chosen.triangle;
  if (c.has(Feature::instances)) c.hits.instance[i] = chosen.instance;
  c.hits.u[i] = static_cast<float>(chosen.u);
  c.hits.v[i] = static_cast<float>(chosen.v);
}

}  // namespace

void settleCoplanar(Chunk& c) {
  const Scene& scene = *c.frame->scene;
  std::fill_n(c.hits.alsoCrossed, c.n, 0u);
  for (std::size_t i = 0; i < c.n; ++i) {
    if (!scene.coplanar.any(c.hits.triangle[i])) continue;
    const reference::Settled settled = reference::settleCoplanar(
        scene, c.frame->effects, reference::rayOf(c, i), reference::candidateOf(c, i));
    if (!settled.isCoplanar) continue;
    setSurface(settled.candidate, i, c);
    c.hits.t[i] = static_cast<float>(settled.hit.t);
    c.hits.alsoCrossed[i] = settled.alsoCrossed;
  }
}

void settleSpheres(Chunk& c) {
  for (std::size_t i = 0; i < c.n; ++i) {
    const reference::Candidate found = reference::candidateOf(c, i);
    const reference::Candidate chosen =
        reference::settleSpheres(*c.frame->scene, c.frame->effects, found);
    const bool isFound = chosen.triangle == found.triangle && chosen.instance == found.instance;
    if (!isFound) setSurface(chosen, i, c);
  }
}

}  // namespace whit
