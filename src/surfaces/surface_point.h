// The point of a surface that a ray hits, and where rays start that go on from there.
#pragma once

#include "surfaces/intersect.h"

namespace whit {

struct SurfacePoint {
  Vec3d position;
  Vec3d geometricNormal;  // unit, the surface's, on the viewer's side
  double offset = 0;      // how far along the geometric normal a new ray must start
  double viewOffset = 0;  // on the viewer's side, how far back along the viewer's ray as well
  bool entering = false;  // the ray hits the outside, where corners run counter-clockwise
};

// `hit` must lie on the candidate's surface (refineHit); the ray's direction has unit length.
//
// `offset` bounds the rounding error, along the normal, of a float hit point interpolated from
// float corners: at most 32 * 2^-24 times the sum of the magnitudes that go into it, as where
// `sharesPlace` says that other surfaces lie there (hard cases H1-H4; after the error bounds of
// Pharr, Jakob and Humphreys, Physically Based Rendering, section 6.8).
SurfacePoint surfacePoint(const Scene& scene, const Candidate& candidate, const TriangleHit& hit,
                          const Ray& ray, bool sharesPlace = false);

}  // namespace whit
