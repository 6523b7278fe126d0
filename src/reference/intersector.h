// The interface through which the reference queries geometry. Embree or brute force may answer;
// either way the reference computes t, u, v and the hit point again in double from the corners.
#pragma once

#include <cstdint>

#include "core/vec3.h"
#include "scene/camera.h"
#include "stages/ray_kinds.h"

namespace whit::reference {

struct Ray {
  Vec3d origin, direction;
  RayCone cone{};    // for texture lookups
  double tNear = 0;  // hits at this distance or nearer are ignored
};

inline constexpr std::uint32_t kNoHit = 0xffffffffu;

struct Candidate {
  std::uint32_t triangle = kNoHit;  // index into Scene::triangles
  std::uint32_t instance = kNoHit;  // index into Scene::instances, kNoHit: in the world
  // Barycentric weights of corners 1 and 2 as the intersector saw them; only a hint.
  double u = 0, v = 0;
};

struct Impulse;

class Intersector {
 public:
  virtual ~Intersector() = default;

  // Finds the closest hit beyond the ray's tNear, outside the holes of alpha masks. False if there
  // is none.
  virtual bool closest(const Ray& ray, Candidate& candidate) const = 0;

  // Called for each triangle that a path goes on from: among coplanar ones, the one that was
  // chosen.
  virtual void met(const Candidate&) const {}

  // Called before each impulse is followed, and with the radiance that it returns, unweighted.
  virtual void began(const Impulse&, RayKind) const {}
  virtual void ended(const RgbD& /*radiance*/) const {}

  // Called when the sample that was begun last is traced again (sampling/ray_limit.h).
  virtual void beganAgain() const {}

  // True if a surface that casts shadows lies at 0 < t < tFar (direction not normalized).
  virtual bool occluded(const Ray& ray, double tFar) const = 0;
};

}  // namespace whit::reference
