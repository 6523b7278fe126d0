// The surfel of the scalar reference, and the reference of one vector step: one row of what the
// step has written into its chunk, computed again in double from what the step has read. The
// function has the name of its stage and is in its file.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "bake/mip_maps.h"
#include "core/shading_choices.h"
#include "core/vec3.h"
#include "scene/camera.h"
#include "stages/chunk.h"
#include "stages/columns.h"
#include "surfaces/surface_point.h"

namespace whit::reference {

// How the facets of frosted glass scatter what passes it, in frames that sample them.
struct Frosting {
  bool ofInterface = false;  // they are those of the interface between two media
  bool ofSheet = false;      // or those of a sheet that has the same medium on both sides
  bool reflects = false;     // the facets of a sheet reflect as its glossy lobe says
  double n1 = 1, n2 = 1;     // refractive indices in front and behind
  RgbD transmission;         // what the surface lets pass of the light that no facet reflects
  std::uint32_t mediaBehind = 0;
};

// A point of a surface with all that shading needs to know about it.
struct Surfel : SurfacePoint {
  Vec3d view;           // unit, back along the ray
  Vec3d shadingNormal;  // unit, interpolated and bent by the normal map; see makeSurfel
  Vec3d shadowOffset;   // leads from the facet to the surface of its vertex normals
  std::uint32_t material = 0;
  RgbD diffuse, specular;                       // textures and vertex colors applied
  double grazingRatio = double{kGrazingRatio};  // the material's
  // Maps and vertex colors multiply the material's own values by these.
  RgbD emission{1, 1, 1}, mirror{1, 1, 1}, transmission{1, 1, 1};
  double alpha = 1;         // width of the glossy lobe (GGX), roughness squared
  double coverage = 1;      // the share of the surface that is there
  double occlusion = 1;     // what indirect light is multiplied by
  RgbD aboveLobe{1, 1, 1};  // what mirror and interface leave for the samples of the lobe
  RgbD underCoat{1, 1, 1};  // what a coat leaves of the light of lamps for the lobe
  RgbD lobe;                // what the lobe takes of the light that the mirror leaves
  Frosting frosting;
  RayCone cone;  // cone of the rays that go on from here
};

// One coordinate, moved towards `direction`.
inline double moved(double coordinate, double direction) {
  constexpr float kNearOrigin = 1.0f / 32, kStepThere = 1.0f / 65536, kUlps = 256;
  const auto p = static_cast<float>(coordinate), n = static_cast<float>(direction);
  if (std::fabs(p) < kNearOrigin) return p + kStepThere * n;
  const auto ulps = static_cast<std::int32_t>(kUlps * n);
  return std::bit_cast<float>(std::bit_cast<std::int32_t>(p) + (p < 0 ? -ulps : ulps));
}

// `side` is 1 for the viewer's side of the surface, -1 for the other. Waechter and Binder's method
// is one on the bits of floats: the position is rounded to float for it.
inline Vec3d rayOrigin(OffsetMethod method, const Surfel& surfel, double side) {
  const Vec3d n = surfel.geometricNormal * side, p = surfel.position;
  switch (method) {
    case OffsetMethod::wachterBinder:
      return {moved(p.x, n.x), moved(p.y, n.y), moved(p.z, n.z)};
    case OffsetMethod::fixed:
      return p + n * double{kFixedOffset};
    case OffsetMethod::bound:
      break;
  }
  const Vec3d back = side > 0 ? surfel.view * surfel.viewOffset : Vec3d{};
  return p + n * surfel.offset + back;
}

// The inputs of reference functions besides their chunk: the scene, of which kernels have float
// tables.
struct World {
  const Scene& scene;
  EffectSet effects;              // effects of the plan
  const MipMaps* maps = nullptr;  // mip maps of the scene, if lookups are trilinear
  CameraFrame camera;
  const Intersector& intersector;  // for shadow rays and what surrounds the eye
};

// Slots of the chunk's columns in the reference's own terms.
inline Surfel surfelOf(const Chunk& chunk, std::size_t slot) {
  const SurfelRow r = SurfelRow::at(chunk.surfels, slot);
  Surfel s;
  s.position = r.pos;
  s.view = -rayOf(chunk, slot).direction;
  s.geometricNormal = r.ng;
  s.shadingNormal = r.ns;
  s.shadowOffset = r.shadowOffset;
  s.offset = r.offset;
  s.viewOffset = r.viewOffset;
  s.entering = (r.flags & kEntering) != 0;
  s.material = r.material;
  s.diffuse = r.diffuse;
  s.specular = r.specular;
  if (chunk.has(Feature::emissionFactors)) s.emission = r.emission;
  if (chunk.has(Feature::mirrorMaps)) s.mirror = r.mirror;
  if (chunk.has(Feature::transmissionMaps)) s.transmission = r.transmission;
  if (chunk.has(Feature::glossy)) s.alpha = r.alpha;
  s.lobe = r.lobe;
  if (chunk.has(Feature::coverage)) s.coverage = r.coverage;
  if (chunk.has(Feature::occlusionMaps)) s.occlusion = r.occlusion;
  s.cone.width = r.cone;
  return s;
}

inline std::uint32_t mediaOf(const Chunk& chunk, std::size_t slot) {
  return chunk.has(Feature::transmission) ? chunk.rays.media[slot] : 0;
}

inline std::uint32_t alsoCrossedAt(const Chunk& chunk, std::size_t slot) {
  return chunk.has(Feature::coplanar) ? chunk.hits.alsoCrossed[slot] : 0;
}

inline bool isHidden(const Chunk& chunk, std::size_t slot) {
  return chunk.has(Feature::transmission) && (chunk.surfels.flags[slot] & kHidden) != 0;
}

}  // namespace whit::reference
