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
  double tNear = 0;  // what is not farther than this is passed over
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
  // The nearest triangle along the ray, beyond its tNear; alpha masks are respected. False: none.
  virtual bool closest(const Ray& ray, Candidate& candidate) const = 0;
  // Told of each triangle that a path goes on from: of those in one place, the one that counts.
  virtual void met(const Candidate&) const {}
  // Told of each impulse that is followed, and of what it brought back before its weight counts.
  virtual void began(const Impulse&, RayKind) const {}
  virtual void ended(const RgbD& /*radiance*/) const {}
  // Told that the sample which was begun last is traced again (sampling/ray_limit.h).
  virtual void beganAgain() const {}
  // True if a surface that casts shadows lies at 0 < t < tFar (direction not normalized).
  virtual bool occluded(const Ray& ray, double tFar) const = 0;
};

}  // namespace whit::reference
