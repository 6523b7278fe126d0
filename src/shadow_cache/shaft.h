// All that shadow rays pass through on their way from a receiver to a light, for leaving out boxes.
#pragma once

#include "core/box.h"
#include "scene/light.h"
#include "shadow_cache/receiver.h"
#include "simd/meet_casters.h"

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

// Rounded outwards.
void setBox(simd::BoxBlock& block, std::size_t i, const Box& box);

class Shaft {
 public:
  // A directional light's shaft ends `length` away.
  Shaft(const Receiver& receiver, const LightPoint& light, double length);

  // For kernels that test many boxes, or triangles.
  simd::RoundedShaft rounded() const;
  const simd::ShaftSides& sides() const { return sides_; }
  // True if the shaft surely misses the box.
  bool misses(const Box& box) const;

 private:
  void addPlane(const Vec3d& normal, const Vec3d& through, const Vec3d& inside);

  static_assert(simd::RoundedShaft::kMostPlanes == Receiver::kMostCorners + 1);
  simd::ShaftSides sides_;
  double reach_;
};

}  // namespace whit
