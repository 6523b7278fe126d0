// All that shadow rays pass through on their way from a receiver to a light, for leaving out boxes.
#pragma once

#include "core/box.h"
#include "shadow_cache/caster.h"
#include "simd/meet_casters.h"

namespace whit {

// Rounded outwards.
void setBox(simd::BoxBlock& block, std::size_t i, const Box& box);

class Shaft {
 public:
  // A directional light's shaft ends `length` away.
  Shaft(const Receiver& receiver, const LightPoint& light, double length);

  // For kernels that test many boxes, or triangles.
  simd::RoundedShaft rounded() const;
  const simd::ShaftSides& sides() const { return sides_; }
  // True if the shaft surely misses the box, or the triangle by more than `distance` (the scalar
  // reference of the kernels).
  bool misses(const Box& box) const;
  bool misses(const TriangleRecord& triangle, double distance) const;

 private:
  void addPlane(const Vec3d& normal, const Vec3d& through, const Vec3d& inside);

  static_assert(simd::RoundedShaft::kMostPlanes == Receiver::kMostCorners + 1);
  simd::ShaftSides sides_;
  double reach_;
};

}  // namespace whit
