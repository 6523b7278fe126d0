// The quantities of each stage that `whit compare --stages` compares, and the largest allowed
// difference between a vector step and the scalar reference. The tables at the end contain all
// knowledge about columns. A column without an entry is compared by itself: whole numbers have to
// be equal, others within kRoundedLimit.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bake/sphere.h"
#include "reference/find_intersections.h"
#include "reference/find_radiance_and_shadow_rays.h"
#include "reference/sphere.h"
#include "reference/triangle.h"
#include "reference/twin.h"
#include "scene/light.h"

namespace whit {

// Limits, in ulps of the largest component, with the reasons for their sizes.
inline constexpr double kRoundedLimit = 4;    // a few products and sums
inline constexpr double kDirectionLimit = 4;  // a normalized sum of three products
inline constexpr double kPositionLimit = 4;   // three products, against the largest corner
// An ulp of the normal along the edges, of which the offset counts 16, against the 2^-6 that it
// counts of all; times two for what the normal and the edges are rounded themselves.
inline constexpr double kOffsetLimit = 2048;
inline constexpr double kLiftLimit = 8;    // three products of two positions' difference
inline constexpr double kNormalLimit = 4;  // cross product by differences of products, normalized
// An ulp of a texture coordinate u is 2^-23 u of a repeat; times the texture's size in texels and
// the contrast between two of them it is a visible number of ulps of the color (hard case H68).
inline constexpr double kTexturedLimit = 4096;
inline constexpr double kSkyLimit = 512;  // likewise, for azimuth and elevation
// A footprint that is wrong by so many ulps moves the lookup between mip levels, whose contrast may
// be that of the color; of a compact triangle that is seen head on.
inline constexpr double kFootprintLimit = 16;
inline constexpr double kConeLimit = 2;       // one product and one sum
inline constexpr double kRadianceLimit = 32;  // a dozen factors, some of them squared
inline constexpr double kWeightLimit = 4096;  // Fresnel's root at the critical angle: 4e-4 (H37)
inline constexpr double kChildLimit = 512;    // the refracted direction there: 3e-5 (H37)
inline constexpr double kSumLimit = 1;        // one addition
inline constexpr double kExact = 0;

inline double ulpOf(double magnitude) {
  const float m = static_cast<float>(std::fabs(magnitude));
  // Far below anything visible, and far enough above the least normal float for its ulp to be one
  // too: workers flush what is smaller to zero.
  constexpr float least = 1e-25f;
  const float at = std::max(m, least);
  return static_cast<double>(std::nextafter(at, std::numeric_limits<float>::infinity()) - at);
}

// Where a row stands, and what the scalar reference says.
template <typename Row>
struct Place {
  const reference::World& world;
  const Chunk& chunk;
  std::size_t slot;
  const Row& twin;
};

// Columns that are compared as one, and the magnitude that its ulps are at least those of: the rule
// gives 0 where the values' own decides, kNotHere where double and float need not agree at all.
inline constexpr double kNotHere = -1;
template <typename Row>
struct Quantity {
  Stage stage;
  std::string name;
  std::vector<std::string> columns;
  double limit;
  double (*scale)(const Place<Row>&) = nullptr;  // null: 0 everywhere
};

template <typename Row>
double byOne(const Place<Row>&) {
  return 1;
}

// The shadow slot is an index and is not compared.
inline double byNothing(const Place<ShadowRow>&) { return kNotHere; }

inline double byEye(const Place<RayRow>& p) { return maxComponent(abs(p.world.camera.eye)); }

// Near the critical angle the root amplifies rounding without bound; there the weight of the
// refracted ray goes to zero with it.
template <double (*kScale)(const Place<RayRow>&)>
double whereItCounts(const Place<RayRow>& p) {
  const double largest = std::max({p.twin.weightR, p.twin.weightG, p.twin.weightB});
  return largest < 0.05 ? kNotHere : kScale(p);
}
inline double byItself(const Place<RayRow>&) { return 0; }

inline double cosineOf(const Place<SurfelRow>& p) {
  const SurfelRow& s = p.twin;
  return std::fabs(dot(Vec3d{s.ngX, s.ngY, s.ngZ}, reference::rayOf(p.chunk, p.slot).direction));
}
// A surface seen edge on may be entered in one precision and left in the other.
template <double (*kScale)(const Place<SurfelRow>&)>
double notEdgeOn(const Place<SurfelRow>& p) {
  return cosineOf(p) < 1e-5 ? kNotHere : kScale(p);
}
inline double byItself(const Place<SurfelRow>&) { return 0; }
inline Corners cornersAt(const Place<SurfelRow>& p) {
  const reference::Candidate candidate = reference::candidateOf(p.chunk, p.slot);
  const Scene& scene = p.world.scene;
  if (!scene.isSphere(candidate.triangle)) {
    return worldCorners(scene, candidate.triangle, candidate.instance);
  }
  const bool placed = candidate.instance != reference::kNoHit;
  return cornersOf(touchingTriangle(scene.triangles[candidate.triangle], candidate.u, candidate.v),
                   placed ? &scene.instances[candidate.instance].toWorld : nullptr);
}
// How much the cross product of the edges amplifies their rounding.
inline double bySliver(const Place<SurfelRow>& p) {
  const Corners c = cornersAt(p);
  const Vec3d a = c[1] - c[0], b = c[2] - c[0];
  return length(a) * length(b) / std::max(length(cross(a, b)), 1e-300);
}
// The map that makes the sphere of the unit sphere, in the world; none on triangles.
inline std::optional<Affine> sphereAt(const Place<SurfelRow>& p) {
  const reference::Candidate candidate = reference::candidateOf(p.chunk, p.slot);
  if (!p.world.scene.isSphere(candidate.triangle)) return {};
  return sphereInWorld(p.world.scene, {candidate.triangle, candidate.instance});
}
inline Vec3d axesOf(const Affine& map) { return abs(map.x) + abs(map.y) + abs(map.z); }
// The magnitude of a position that placeSurfel found along the ray; none where it follows from the
// corners.
inline std::optional<double> alongRay(const Place<SurfelRow>& p) {
  const double t = double{p.chunk.hits.t[p.slot]};
  const Corners c = cornersAt(p);
  const auto sphere = sphereAt(p);
  const Vec3d edges =
      sphere ? axesOf(*sphere) * double{kSphereSpan} : abs(c[1] - c[0]) + abs(c[2] - c[0]);
  const bool placed = reference::candidateOf(p.chunk, p.slot).instance != reference::kNoHit;
  const bool shared = reference::alsoCrossedAt(p.chunk, p.slot) >= kSharesPlace;
  if (placed || shared || (!sphere && bySliver(p) > 0x1p11) ||
      !(8 * t < edges.x + edges.y + edges.z))
    return {};
  const SurfelRow& s = p.twin;
  const double across = dot(abs(Vec3d{s.ngX, s.ngY, s.ngZ}), edges);
  return std::fabs(s.posX) + std::fabs(s.posY) + std::fabs(s.posZ) + 4 * t + across;
}
// By the corners, which may be far larger than the place that a ray found. Of an instance the
// offset is 32 units in the last place of all that went into the position, and 16 of its edges,
// whose products with the weights are rounded too.
inline double byMagnitude(const Place<SurfelRow>& p) {
  if (const auto found = alongRay(p)) return *found;
  if (const auto sphere = sphereAt(p)) {
    const Vec3d size = axesOf(*sphere) + abs(sphere->p);
    return size.x + size.y + size.z;
  }
  Vec3d largest;
  for (const Vec3d& corner : cornersAt(p)) largest = max(largest, abs(corner));
  return std::max(largest.x + largest.y + largest.z, p.twin.offset * 0x1p19);
}
// From slivers of 2^14 on another offset counts; rounding decides what is one.
inline double byOffset(const Place<SurfelRow>& p) {
  const double sliver = bySliver(p);
  return sliver > 0x1p11 ? kNotHere : sliver * p.twin.offset;
}
inline double bySliverIfMapped(const Place<SurfelRow>& p) {
  return p.world.effects.has(Effect::normalMaps) ? bySliver(p) : kNotHere;
}
inline double bySliverIfNotMapped(const Place<SurfelRow>& p) {
  return p.world.effects.has(Effect::normalMaps) ? kNotHere : bySliver(p);
}
// The footprint is as uncertain as area and cosine, which it is divided by.
inline double byFootprint(const Place<SurfelRow>& p) {
  if (!p.world.maps) return 1;
  return std::max(1.0, kFootprintLimit / kTexturedLimit * bySliver(p) / cosineOf(p));
}

inline double ofMisses(const Place<RadianceRow>& p) {
  return p.chunk.surfels.material[p.slot] == kMiss ? 0 : kNotHere;
}
inline double ofSurfels(const Place<RadianceRow>& p) {
  return p.chunk.surfels.material[p.slot] == kMiss ? kNotHere : 0;
}

// A point on a light is found from its center by a sine, a cosine, three roots and a change of
// frame: its direction is off by up to four ulps more than that of the center, which is one
// difference.
inline double byPointOfLight(const Chunk& chunk) { return chunk.lightSamples > 1 ? 4 : 1; }

// The radiance without the cosine at the light's point, because the rounding error of the cosine is
// absolute. A highlight moves by an ulp of the half vector over the width of the lobe.
inline double byGrazing(const Place<UnshadowedRow>& p) {
  if (p.chunk.lightIsAmbient()) return 0;
  const Light& light = *p.chunk.light;
  const reference::Surfel s = reference::surfelOf(p.chunk, p.slot);
  const Vec3d l = normalized(reference::arrivalAt(p.world, p.chunk, p.slot).shadowRay.direction);
  const double width = maxComponent(s.specular) > 0 ? s.alpha : 1;
  const double scale = byPointOfLight(p.chunk) * std::max({p.twin.r, p.twin.g, p.twin.b}) /
                       (std::max(dot(l, s.shadingNormal), 1e-4) * width);
  if (light.kind != Light::Kind::spot) return scale;
  // The cosine to the cone's axis has an absolute error too, relative to the width of its edge.
  const SpotCone cone = coneOf(light);
  return scale * std::max(1.0, 2 * cone.scale / std::max(std::sqrt(cone.falloff(l)), 1e-4));
}
// A difference of two positions; or of ambient light by a sine, a cosine and a change of frame.
inline double byBothEnds(const Place<ShadowRow>& p) {
  if (p.chunk.lightIsAmbient()) return 4;
  const Light& light = *p.chunk.light;
  if (light.kind == Light::Kind::directional) return 1;
  return byPointOfLight(p.chunk) *
         (maxComponent(abs(Vec3d(light.position))) +
          maxComponent(abs(Vec3d{p.twin.orgX, p.twin.orgY, p.twin.orgZ})));
}

inline std::vector<std::string> xyz(const std::string& s) { return {s + "X", s + "Y", s + "Z"}; }
inline std::vector<std::string> rgb(const std::string& s) { return {s + "R", s + "G", s + "B"}; }

// The quantities of each kind of row.
inline std::vector<Quantity<RayRow>> quantitiesOf(const RayRow*) {
  using enum Stage;
  // And what the cutoff counts of it.
  const std::vector<std::string> weight{"weightR", "weightG", "weightB", "throughput"};
  return {
      {generateRays, "origin", xyz("org"), kPositionLimit, byEye},
      {generateRays, "dir", xyz("dir"), kDirectionLimit, byOne},
      {generateRays, "weight", weight, kExact},
      {generateRays, "parent", {"parent"}, kExact},
      {generateRays, "media", {"media"}, kExact},
      {generateRays, "cone", {"cone"}, kConeLimit},
      {addImpulses, "weight", weight, kWeightLimit, byOne},
      {addImpulses, "direction", xyz("dir"), kChildLimit, whereItCounts<byOne>},
      {addImpulses, "origin", xyz("org"), kPositionLimit, whereItCounts<byItself>},
      {addImpulses, "cone", {"cone"}, kExact, whereItCounts<byItself>},
      {addImpulses, "media", {"media"}, kExact, whereItCounts<byItself>},
  };
}
inline std::vector<Quantity<SurfelRow>> quantitiesOf(const SurfelRow*) {
  constexpr Stage stage = Stage::findIntersections;
  return {
      {stage, "position", xyz("pos"), kPositionLimit, byMagnitude},
      {stage, "offset", {"offset"}, kOffsetLimit, byOffset},
      {stage, "retreat", {"retreat"}, kOffsetLimit, byOffset},
      {stage, "geometricNormal", xyz("ng"), kNormalLimit, notEdgeOn<bySliver>},
      {stage, "shadingNormal", xyz("ns"), kNormalLimit, notEdgeOn<bySliverIfNotMapped>},
      {stage, "shadingNormal", xyz("ns"), kTexturedLimit, notEdgeOn<bySliverIfMapped>},
      {stage, "diffuse", rgb("diffuse"), kTexturedLimit, notEdgeOn<byFootprint>},
      {stage, "specular", rgb("specular"), kTexturedLimit, notEdgeOn<byFootprint>},
      {stage, "alpha", {"alpha"}, kTexturedLimit, notEdgeOn<byFootprint>},
      {stage, "emission", rgb("emission"), kTexturedLimit, notEdgeOn<byFootprint>},
      {stage, "coverage", {"coverage"}, kTexturedLimit, notEdgeOn<byFootprint>},
      {stage, "lift", xyz("lift"), kLiftLimit, notEdgeOn<byMagnitude>},
      {stage, "cone", {"cone"}, kConeLimit},
      {stage, "flags", {"flags"}, kExact, notEdgeOn<byItself>},
      {stage, "mediaBehind", {"mediaBehind"}, kExact, notEdgeOn<byItself>},
  };
}
inline std::vector<Quantity<RadianceRow>> quantitiesOf(const RadianceRow*) {
  using enum Stage;
  return {
      {writeEmittedAndReflectiveAmbient, "sky", {"r", "g", "b"}, kSkyLimit, ofMisses},
      {writeEmittedAndReflectiveAmbient, "radiance", {"r", "g", "b"}, kRadianceLimit, ofSurfels},
      {addShading, "radiance", {"r", "g", "b"}, kSumLimit},
  };
}
inline std::vector<Quantity<UnshadowedRow>> quantitiesOf(const UnshadowedRow*) {
  using enum Stage;
  return {
      {findRadianceAndShadowRays, "unshadowed", {"r", "g", "b"}, kRadianceLimit, byGrazing},
      {checkShadows, "visible", {"visible"}, kExact},
  };
}
inline std::vector<Quantity<ShadowRow>> quantitiesOf(const ShadowRow*) {
  constexpr Stage stage = Stage::findRadianceAndShadowRays;
  return {
      {stage, "shadowOrigin", xyz("org"), kPositionLimit},
      {stage, "shadowDirection", xyz("dir"), kPositionLimit, byBothEnds},
      {stage, "shadowEnd", {"tFar"}, kRoundedLimit, byOne},
      {stage, "slot", {"slot"}, kExact, byNothing},
  };
}

}  // namespace whit
