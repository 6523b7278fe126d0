// A surfel: a point of a surface with all that shading needs to know about it.
#pragma once

#include "core/effects.h"
#include "core/shading_choices.h"
#include "reference/intersector.h"
#include "reference/triangle.h"
#include "scene/mip_maps.h"
#include "scene/scene.h"

namespace whit::reference {

inline constexpr double kUnitRoundOff = 0x1p-24;  // of float

struct Surfel {
  Vec3d position;
  Vec3d view;             // unit, back along the ray
  Vec3d geometricNormal;  // unit, the triangle's, on the viewer's side
  Vec3d shadingNormal;    // unit, interpolated and bent by the normal map; see makeSurfel
  Vec3d lift;             // from the facet to the surface its vertex normals stand for
  double offset = 0;      // how far along the geometric normal a new ray must start
  bool entering = false;  // the ray met the outside, where corners run counter-clockwise
  std::uint32_t material = 0;
  RgbD diffuse, specular;  // textures and vertex colors applied
  RgbD emission{1, 1, 1};  // what they multiply the material's by
  double alpha = 1;        // width of the glossy lobe (GGX), roughness squared
  RayCone cone;            // of rays that go on from here
};

// How makeSurfel looks textures up.
struct TextureLookup {
  TextureFilter filter = TextureFilter::bilinear;
  const MipMaps* maps = nullptr;  // of the scene, if trilinear
  RayCone cone{};                 // at the hit: what a ray starts with that goes on from there
};

// `hit` must lie on the candidate's triangle (refineHit); `direction` is the ray's, unit length.
//
// The geometric normal alone decides which side was met, and both normals are turned over for a ray
// that meets the inside, so that surfaces are two-sided. The shading normal may still point away
// from the viewer, or disagree with the geometric one about a light; whoever uses it must check.
//
// `offset` bounds the rounding error of a float hit point interpolated from float corners:
// 32 * 2^-24 times the sum of the magnitudes that go into it (hard cases H1-H4; after the error
// bounds of Pharr, Jakob and Humphreys, Physically Based Rendering, section 6.8).
Surfel makeSurfel(const Scene& scene, EffectSet effects, const Candidate& candidate,
                  const TriangleHit& hit, const Vec3d& direction, const TextureLookup& lookup = {});

// The area of texture space, spanned by `uvs` (Scene::uvsOf), of which a repeat is 1, that a cone
// of this width covers about the hit, if it does so alike in all directions: its section by the
// triangle's plane is that much longer than wide, and counts as if it were as wide (Akenine-Moeller
// et al. 2019, section 20.3.4). `cosine` is that between ray and plane's normal.
double textureFootprint(const TriangleRecord& triangle, const float* uvs, const Affine* toWorld,
                        double coneWidth, double cosine);

// How far the hit lies below the tangent planes of the triangle's corners, weighed as the corners
// are; beyond `s.offset`, so that it is exactly 0 on flat faces (Hanika 2021, "Hacking the shadow
// terminator", Ray Tracing Gems II, chapter 4). Part of makeSurfel.
Vec3d terminatorLift(const Scene& scene, EffectSet effects, const Candidate& candidate,
                     const TriangleHit& hit, const Surfel& s);

// Texture coordinates at the hit, from those of the corners (Scene::uvsOf).
struct TexturePoint {
  double u = 0, v = 0;
};
TexturePoint texturePoint(const float* uvs, const TriangleHit& hit);

// Whether an alpha mask has cut a hole where the ray meets the triangle.
bool cutAway(const Scene& scene, std::uint32_t triangle, const TriangleHit& hit);

}  // namespace whit::reference
