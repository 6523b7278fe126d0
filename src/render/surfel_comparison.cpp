// Surfels, and with them hits and texture lookups, against the reference's.
#include <algorithm>
#include <cmath>

#include "reference/triangle.h"
#include "render/stage_comparer.h"
#include "render/stage_limits.h"
#include "render/widen.h"

namespace whit {

reference::Surfel StageComparer::surfelOf(const ChunkView& c, std::size_t i) const {
  return widenSurfel(c.surfels, directionOf(c.rays, i), i);
}

// How much the cross product of the edges amplifies their rounding.
double StageComparer::sliverFactor(const reference::Candidate& candidate) const {
  const reference::Corners p =
      reference::worldCorners(scene_, candidate.triangle, candidate.instance);
  const Vec3d a = p[1] - p[0], b = p[2] - p[0];
  return length(a) * length(b) / std::max(length(cross(a, b)), 1e-300);
}

void StageComparer::compareSurfels(const ChunkView& c) {
  if (enough(Stage::findIntersections)) return;
  for (std::size_t i = 0; i < c.n; ++i) {
    if (c.hits.triangle[i] != kMiss) compareSurfel(c, i);
  }
}

void StageComparer::compareSurfel(const ChunkView& c, std::size_t i) {
  const reference::Candidate candidate = candidateOf(c.hits, i);
  const reference::TriangleHit hit{static_cast<double>(c.hits.t[i]), candidate.u, candidate.v};
  const reference::Surfel got = surfelOf(c, i);
  const reference::TextureLookup lookup{shading_.textureFilter, maps_ ? &*maps_ : nullptr,
                                        got.cone};
  const reference::Surfel twin =
      reference::makeSurfel(scene_, plan_.effects, candidate, hit, directionOf(c.rays, i), lookup);
  // The offset is 32 units in the last place of all that went into the position.
  const double magnitude = twin.offset * 0x1p19;
  constexpr Stage stage = Stage::findIntersections;
  compare(stage, "position", got.position, twin.position, magnitude, kPositionLimit, c, i);
  // A surface seen edge on may be entered in one precision and left in the other.
  const double cosine = std::fabs(dot(twin.geometricNormal, twin.view));
  if (cosine < 1e-5) return;
  const double sliver = sliverFactor(candidate);
  compare(stage, "geometricNormal", got.geometricNormal, twin.geometricNormal, sliver, kNormalLimit,
          c, i);
  const bool mapped = plan_.effects.has(Effect::normalMaps);
  compare(stage, "shadingNormal", got.shadingNormal, twin.shadingNormal, sliver,
          mapped ? kTexturedLimit : kNormalLimit, c, i);
  // The footprint is as uncertain as area and cosine, which it is divided by.
  const double footprint = maps_ ? kFootprintLimit / kTexturedLimit * sliver / cosine : 0;
  const double color = std::max(1.0, footprint);
  compare(stage, "diffuse", got.diffuse, twin.diffuse, color, kTexturedLimit, c, i);
  if (maps_) {
    const RayCone cone{static_cast<double>(c.rays.cone[i]), job_.coneSpread};
    compare(stage, "cone", Vec3d(got.cone.width), Vec3d(cone.widthAt(hit.t)), 0, kConeLimit, c, i);
  }
  if (plan_.groups.lift) {
    compare(stage, "lift", got.lift, twin.lift, magnitude, kLiftLimit, c, i);
  }
  if (plan_.groups.emission) {
    compare(stage, "emission", got.emission, twin.emission, color, kTexturedLimit, c, i);
  }
  if (plan_.groups.glossy) {
    compare(stage, "specular", got.specular, twin.specular, color, kTexturedLimit, c, i);
  }
}

}  // namespace whit
