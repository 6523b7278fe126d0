// The scalar reference of one vector step: one row of what the step has written into its chunk,
// computed again in double from what the step has read. The function has the name of its stage and
// is in its file.
#pragma once

#include "bake/mip_maps.h"
#include "reference/intersector.h"
#include "reference/surfel.h"
#include "stages/chunk.h"
#include "stages/columns.h"

namespace whit::reference {

// The inputs of reference functions besides their chunk: the scene, of which kernels have float
// tables.
struct World {
  const Scene& scene;
  EffectSet effects;              // of the plan
  const MipMaps* maps = nullptr;  // of the scene, where lookups are trilinear
  CameraFrame camera;
  const Intersector& intersector;  // for shadow rays and what surrounds the eye
};

// Slots of the chunk's columns in the reference's own terms.
inline Ray rayOf(const Chunk& chunk, std::size_t slot) {
  const RayRow r = RayRow::at(chunk.rays, slot);
  return {{r.orgX, r.orgY, r.orgZ}, {r.dirX, r.dirY, r.dirZ}, {r.cone, 0}};
}

inline Candidate candidateOf(const Chunk& chunk, std::size_t slot) {
  const HitRow h = HitRow::at(chunk.hits, slot);
  return {h.triangle, chunk.has(Feature::instances) ? h.instance : kNoHit, h.u, h.v};
}

inline Surfel surfelOf(const Chunk& chunk, std::size_t slot) {
  const SurfelRow r = SurfelRow::at(chunk.surfels, slot);
  Surfel s;
  s.position = {r.posX, r.posY, r.posZ};
  s.view = -rayOf(chunk, slot).direction;
  s.geometricNormal = {r.ngX, r.ngY, r.ngZ};
  s.shadingNormal = {r.nsX, r.nsY, r.nsZ};
  s.lift = {r.liftX, r.liftY, r.liftZ};
  s.offset = r.offset;
  s.retreat = r.retreat;
  s.entering = (r.flags & kEntering) != 0;
  s.material = r.material;
  s.diffuse = {r.diffuseR, r.diffuseG, r.diffuseB};
  s.specular = {r.specularR, r.specularG, r.specularB};
  if (chunk.has(Feature::emissionFactors)) s.emission = {r.emissionR, r.emissionG, r.emissionB};
  if (chunk.has(Feature::glossy)) s.alpha = r.alpha;
  if (chunk.has(Feature::coverage)) s.coverage = r.coverage;
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

// Into three columns of a row.
inline void put(const Vec3d& v, double& x, double& y, double& z) { x = v.x, y = v.y, z = v.z; }

}  // namespace whit::reference
