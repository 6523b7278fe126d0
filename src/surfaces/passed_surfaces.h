// Surfaces that a ray passes although it hits them.
#pragma once

#include "surfaces/intersect.h"

namespace whit {

// True if an alpha mask has cut a hole where the ray hits the triangle; `forShadows`: a hole that
// light falls through (Material::shadowCutoff, coverageCutoff).
bool cutAway(const Scene& scene, std::uint32_t triangle, const TriangleHit& hit,
             bool forShadows = false);

// True if the ray passes the triangle because it hits the back of a single-sided surface.
bool isPassed(const Scene& scene, std::uint32_t triangle, std::uint32_t instance,
              const Vec3d& direction);

}  // namespace whit
