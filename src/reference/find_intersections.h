// findIntersections: from the triangle that a ray has met to the surfel that it sees there (after
// Pharr, Jakob and Humphreys, Physically Based Rendering, chapter 6).
#pragma once

#include <optional>

#include "bake/mip_maps.h"
#include "bake/scene.h"
#include "core/effects.h"
#include "core/shading_choices.h"
#include "reference/world.h"
#include "surfaces/intersect.h"

namespace whit::reference {

// The parameters of makeSurfel's texture lookups.
struct TextureLookup {
  TextureFilter filter = TextureFilter::bilinear;
  const MipMaps* maps = nullptr;  // mip maps of the scene, for trilinear lookups
  RayCone cone{};                 // the cone at the hit, with which rays from there start
};

// Takes what surfacePoint() takes (surfaces/surface_point.h).
//
// The geometric normal alone decides which side was hit, and both normals are turned over for a ray
// that hits the inside, so that surfaces are two-sided. The shading normal may still point away
// from the viewer, or disagree with the geometric one about a light; callers must check.
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
Vec3d shadowTerminatorOffset(const Scene& scene, EffectSet effects, const Candidate& candidate,
                             const TriangleHit& hit, const Surfel& s);

// Returns the row that the step writes for the hit that Embree has found; none where there is no
// hit.
std::optional<SurfelRow> findIntersections(const World& world, const Chunk& chunk,
                                           std::size_t slot);

}  // namespace whit::reference
