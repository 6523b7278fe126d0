// Children of surfels, mirrored, sampled and refracted, against the reference's.
#include "reference/glossy.h"
#include "reference/media.h"
#include "render/stage_comparer.h"
#include "render/stage_limits.h"
#include "render/widen.h"

namespace whit {

void StageComparer::compareChildren(const ChunkView& c) {
  if (enough(Stage::addImpulses)) return;
  for (std::size_t k = 0; k < c.reflections + c.refractions; ++k) {
    const std::size_t i = c.children.parent[k];
    const reference::Impulse twin = childTwin(c, k);
    constexpr Stage stage = Stage::addImpulses;
    const Vec3d weight{c.children.weightR[k], c.children.weightG[k], c.children.weightB[k]};
    compare(stage, "weight", weight, twin.weight, 1, kWeightLimit, c, i);
    // Near the critical angle the root amplifies rounding without bound; there the weight of the
    // refracted ray goes to zero with it.
    if (maxComponent(twin.weight) < 0.05) continue;
    compare(stage, "direction", directionOf(c.children, k), twin.ray.direction, 1, kChildLimit, c,
            i);
    compare(stage, "origin", originOf(c.children, k), twin.ray.origin, 0, kPositionLimit, c, i);
    if (c.children.cone) {
      note(stage, "cone", c.children.cone[k] == c.surfels.cone[i] ? 0 : 1, kExact,
           tracker_.pixel(c, i), c.depth);
    }
    if (c.children.media) {
      note(stage, "media", c.children.media[k] == twin.media ? 0 : 1, kExact, tracker_.pixel(c, i),
           c.depth);
    }
  }
}

reference::Impulse StageComparer::childTwin(const ChunkView& c, std::size_t child) const {
  const std::size_t i = c.children.parent[child];
  const reference::Surfel surfel = surfelOf(c, i);
  const std::uint32_t stack = c.rays.media ? c.rays.media[i] : 0;
  const bool reflected = child < c.reflections;
  if (reflected && c.children.path &&
      c.children.path[child] != childStream(c.rays.path[i], kMirroredBranch)) {
    return sampledTwin(c, child, surfel, stack);
  }
  const reference::Crossing crossing =
      reference::crossMedia(scene_, plan_.effects, surfel.material, surfel.entering, stack);
  const reference::Impulses twins =
      reference::findImpulses(scene_, plan_.effects, surfel, crossing, stack, shading_);
  return reflected ? twins.reflected : twins.refracted;
}

// Of the sample of the lobe that the child's path says it is. None: no weight.
reference::Impulse StageComparer::sampledTwin(const ChunkView& c, std::size_t child,
                                              const reference::Surfel& surfel,
                                              std::uint32_t stack) const {
  const std::uint32_t path = c.rays.path[c.children.parent[child]];
  const LobeSampling sampling = lobeSampling(c.depth, plan_.glossySamples, c.sampleNumber);
  const int rays = reference::lobeRays(surfel, sampling);
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(rays); ++k) {
    if (c.children.path[child] != childStream(path, kFirstGlossyBranch + k)) continue;
    const UnitPoint at = lobePoint(path, sampling, k);
    reference::Impulse twin = reference::glossyImpulse(surfel, stack, at, shading_);
    twin.weight = twin.weight / rays;
    return twin;
  }
  return {};
}

}  // namespace whit
