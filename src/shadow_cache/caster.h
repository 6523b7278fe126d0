// Proofs about one triangle and all shadow rays from a receiver to a light. They hold for the
// numbers that Embree's robust traversal computes in single precision, not only for exact rays.
// Embree's robust test ("modified Pluecker", kernels/geometry/triangle_intersector_pluecker.h) has,
// with corners a, b, c relative to the ray's origin O and its direction D, three edge functions
// D.(a x b), D.(b x c), D.(c x a), all of one sign where the line hits the triangle, and the
// distance (a.N) / (D.N), N the normal. With D = L - O each of these numbers is linear in O: over a
// convex receiver its extremes lie at the corners. Rounding may add at most 2^-24 times the lengths
// that went into each number; the bounds below leave room beside that.
#pragma once

#include <array>

#include "core/vec3.h"
#include "scene/light.h"
#include "shadow_cache/receiver.h"

namespace whit {

// A light without extent. Rays end just before a point light (kShadowReach).
struct LightPoint {
  Vec3d position;  // of a directional light the unit vector towards it
  bool directional = false;

  static LightPoint of(const Light& light);
  bool operator==(const LightPoint&) const = default;
  // Not normalized, as shadow rays have it.
  Vec3d towards(const Vec3d& from) const { return directional ? position : position - from; }
};

enum class Meeting {
  never,   // no ray meets the triangle
  always,  // every one does
  unsure
};

// The scalar reference of simd/meet_casters.cpp, which asks about many triangles.
class Caster {
 public:
  Caster(const TriangleRecord& record, const LightPoint& light);

  Meeting meet(const Receiver& receiver) const;

  // How near a ray must come for Embree to find a hit where there is none, if no ray starts further
  // from the triangle than `distance`: the triangle's shape and its angle to the light decide.
  // Infinite where the light lies in its plane.
  double influence(double distance) const;

 private:
  // A number linear in the ray's origin: (anchor - O) . gradient.
  struct Linear {
    Vec3d anchor, gradient;
    double at(const Vec3d& origin) const { return dot(anchor - origin, gradient); }
  };
  struct Range {
    double least = 0, most = 0;
    bool above(double bound) const { return least > bound; }
    bool below(double bound) const { return most < -bound; }
    bool awayFrom(double bound) const { return above(bound) || below(bound); }
  };
  static Range over(const Receiver& receiver, const Linear& number);
  // Towards the light from the receiver's corners, times the normal.
  Range slope(const Receiver& receiver) const;
  // An upper bound on the products of the corners' distances from the rays and the rays' lengths.
  double farthest(const Receiver& receiver) const;

  struct Bounds;
  Bounds boundsFor(const Receiver& receiver) const;

  LightPoint light_;
  std::array<Vec3d, 3> corner_;
  Vec3d normal_;  // twice the area long
  double longest_ = 0, area2_ = 0;
  std::array<Linear, 3> edges_;
  std::array<double, 3> edgeLength_{}, gradient_{};  // lengths
  double toLight_ = 0;                               // from corner 0; 1 for a directional light
  double lightHeight_ = 0;                           // (v0 - L) . N; of a directional light -D.N
};

}  // namespace whit
