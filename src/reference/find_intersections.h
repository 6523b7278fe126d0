// findIntersections: from the triangle that a ray has met to the surfel that it sees there (after
// Pharr, Jakob and Humphreys, Physically Based Rendering, chapter 6).
#pragma once

#include <optional>

#include "bake/mip_maps.h"
#include "bake/scene.h"
#include "core/effects.h"
#include "core/shading_choices.h"
#include "reference/intersect.h"
#include "reference/world.h"

namespace whit::reference {

// Computes the hit that a candidate stands for again: u, v >= 0, u + v <= 1, t > 0. A hit that
// rounding has put just beside the triangle is moved onto the triangle. Where the intersection is
// undefined, the candidate's own u and v are used.
TriangleHit refineHit(const Scene& scene, const Ray& ray, const Candidate& candidate);

// The parameters of makeSurfel's texture lookups.
struct TextureLookup {
  TextureFilter filter = TextureFilter::bilinear;
  const MipMaps* maps = nullptr;  // those of the scene; needed for trilinear lookups
  RayCone cone{};                 // the cone at the hit, with which rays from there start
};

// `hit` must lie on the candidate's triangle (refineHit); the ray's direction has unit length.
//
// The geometric normal alone decides which side was met, and both normals are turned over for a ray
// that meets the inside, so that surfaces are two-sided. The shading normal may still point away
// from the viewer, or disagree with the geometric one about a light; callers must check.
//
// `offset` bounds the rounding error, along the normal, of a float hit point interpolated from
// float corners: at most 32 * 2^-24 times the sum of the magnitudes that go into it, as where
// `sharesPlace` says that other surfaces lie there (hard cases H1-H4; after the error bounds of
// Pharr, Jakob and Humphreys, Physically Based Rendering, section 6.8).
Surfel makeSurfel(const Scene& scene, EffectSet effects, const Candidate& candidate,
                  const TriangleHit& hit, const Ray& ray, const TextureLookup& lookup = {},
                  bool sharesPlace = false);

// The area of texture space, spanned by `uvs` (Scene::uvsOf), of which a repeat is 1, that a cone
// of this width covers about the hit, if it does so alike in all directions: its section by the
// triangle's plane is that much longer than wide, and counts as if it were as wide (Akenine-Moeller
// et al. 2019, section 20.3.4). `cosine` is that between ray and plane's normal.
double textureFootprint(const TriangleRecord& triangle, const float* uvs, const Affine* toWorld,
                        double coneWidth, double cosine);

// Returns the vector from the hit to the tangent planes of the triangle's corners, weighted by the
// corners' weights; only what exceeds `s.offset` counts, so that it is exactly 0 on flat faces
// (Hanika 2021, "Hacking the shadow terminator", Ray Tracing Gems II, chapter 4). Part of
// makeSurfel.
Vec3d terminatorLift(const Scene& scene, EffectSet effects, const Candidate& candidate,
                     const TriangleHit& hit, const Surfel& s);

// Texture coordinates at the hit, from those of the corners (Scene::uvsOf).
struct TexturePoint {
  double u = 0, v = 0;
};

TexturePoint texturePoint(const float* uvs, const TriangleHit& hit);

// True if an alpha mask has cut a hole where the ray hits the triangle; `forShadows`: a hole that
// light falls through (Material::shadowCutoff, coverageCutoff).
bool cutAway(const Scene& scene, std::uint32_t triangle, const TriangleHit& hit,
             bool forShadows = false);

// True if the ray passes the triangle because it hits the back of a single-sided surface.
bool isPassed(const Scene& scene, std::uint32_t triangle, std::uint32_t instance,
              const Vec3d& direction);

// Returns the row that the step writes for the hit that Embree has found; none where there is no
// hit.
std::optional<SurfelRow> findIntersections(const World& world, const Chunk& chunk,
                                           std::size_t slot);

}  // namespace whit::reference
