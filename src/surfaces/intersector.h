// The interface through which double precision queries geometry. Embree or brute force may answer;
// either way t, u, v and the hit point are computed again in double from the corners.
#pragma once

#include <cstdint>

#include "core/vec3.h"
#include "scene/camera.h"
#include "stages/chunk.h"
#include "stages/columns.h"

namespace whit {

struct Ray {
  Vec3d origin, direction;
  RayCone cone{};    // cone for texture lookups
  double tNear = 0;  // hits at this distance or nearer are ignored
};

inline constexpr std::uint32_t kNoHit = 0xffffffffu;

struct Candidate {
  std::uint32_t triangle = kNoHit;       // index into Scene::triangles
  std::uint32_t instance = kNoInstance;  // index into Scene::instances, or kNoInstance in the world
  // Barycentric weights of corners 1 and 2 as the intersector saw them; only a hint.
  double u = 0, v = 0;
};

class Intersector {
 public:
  virtual ~Intersector() = default;

  // Finds the closest hit beyond the ray's tNear, outside the holes of alpha masks. False if there
  // is none.
  virtual bool closest(const Ray& ray, Candidate& candidate) const = 0;

  // True if a surface that casts shadows lies at 0 < t < tFar (direction not normalized).
  virtual bool occluded(const Ray& ray, double tFar) const = 0;
};

// The ray and the hit of a slot of the chunk.
inline Ray rayOf(const Chunk& chunk, std::size_t slot) {
  const RayRow r = RayRow::at(chunk.rays, slot);
  return {r.org, r.dir, {r.cone, 0}};
}

inline Candidate candidateOf(const Chunk& chunk, std::size_t slot) {
  const HitRow h = HitRow::at(chunk.hits, slot);
  return {h.triangle, chunk.has(Feature::instances) ? h.instance : kNoInstance, h.u, h.v};
}

}  // namespace whit
