// A placed triangle, tests whether two of them overlap or touch in one plane, the part of one that
// another covers, which of them is hit, and surfaces that contain the eye.
#pragma once

#include <tuple>

#include "bake/scene.h"
#include "core/affine.h"

namespace whit {

using Corners = std::array<Vec3d, 3>;

// Returns the map of an instance, none for kNoInstance.
inline const Affine* toWorldOf(const Scene& scene, std::uint32_t instance) {
  return instance == kNoInstance ? nullptr : &scene.instances[instance].toWorld;
}

// Returns the corners, transformed by the map if there is one.
Corners cornersOf(const TriangleRecord& triangle, const Affine* toWorld);

// Returns the corners of a triangle of the scene (an index into Scene::triangles), transformed by
// the instance unless that is kNoInstance.
Corners worldCorners(const Scene& scene, std::uint32_t triangle, std::uint32_t instance);

// Upper bound on the error of a surface point, relative to the sum of magnitudes that magnitudeOf()
// computes. Rays that start there are offset by no more (Surfel::offset).
inline constexpr double kErrorOfMagnitude = 32 * 0x1p-24;

// Sum over the axes of the magnitudes of the terms that make up the point, transformed by the map
// if there is one.
double magnitudeOf(const Vec3d& point, const Affine* toWorld);

struct Facet {
  Corners corners;
  Vec3d normal;  // unit; zero for a triangle without area
  // Its share of how far two triangles in one plane may be apart, and of how much two that overlap
  // must have in common. Both are kErrorOfMagnitude times the largest magnitude of a corner, except
  // in the search of a geometry for all of its instances at once.
  double error = 0, least = 0;
};

Facet facetOf(const TriangleRecord& triangle, const Affine* toWorld);
Facet facetOf(const Scene& scene, PlacedTriangleId id);

double leastAltitude(const Facet& facet);

// Both tests are false for facets without area and for facets that do not lie in one plane.
bool facetsOverlap(const Facet& a, const Facet& b);
bool facetsTouch(const Facet& a, const Facet& b);
// True if facetsOverlap() is false for the facet and any other one.
bool isTooNarrowToOverlap(const Facet& facet);
// The part of `on` that `of`, in its plane, covers.
CoveredPart coveredPart(const Facet& on, const Facet& of);

// Returns the preference for one of several coincident surfaces; light hits the greatest. Opaque
// surfaces come before sheets, and these before dielectrics, of which the highest priority wins.
// Among equals the greatest rank wins: that of the surface that was written last in the scene.
inline auto preferenceOf(const Scene& scene, bool opaque, std::uint32_t medium,
                         std::uint64_t rank) {
  return std::tuple(opaque, medium == 0, scene.media[medium].priority, rank);
}

// True if the transform of the instance mirrors, so that it swaps the sides of triangles; false in
// the world.
inline bool isMirrored(const Scene& scene, std::uint32_t instance) {
  const Affine* toWorld = toWorldOf(scene, instance);
  return toWorld && toWorld->determinant() < 0;
}

// True if the eye lies in the triangle's plane, up to the rounding of the eye's coordinates. It
// sees nothing of such a surface, on whichever side a rounded distance of next to 0 would put it.
bool liesInPlane(const Vec3d& eye, const Corners& corners);

// True if the eye lies in a surface of the scene, given by its number: a triangle's plane, or a
// sphere.
bool liesInSurface(const Scene& scene, const Vec3d& eye, std::uint32_t number,
                   std::uint32_t instance);

// Distance along a ray from the eye, in lengths of its direction, within which surfaces that
// contain the eye are skipped at attempt 0. It doubles with each further attempt.
double distancePastEye(const Vec3d& eye, int attempt);
inline constexpr int kAttemptsPastEye = 40;

}  // namespace whit
