// Where shadow rays start: a piece of a triangle, and how far from it rounding may have moved them;
// and all that they pass through on their way to a light, for leaving out boxes.
#pragma once

#include <array>

#include "bake/scene.h"
#include "core/vec3.h"
#include "scene/light.h"
#include "simd/meet_casters.h"
#include "stages/shadow_cache_view.h"

namespace whit {

// A square of weights: from (u, v), `side` wide.
struct WeightSquare {
  double u = 0, v = 0, side = 1;
};

class ReceivingTriangle {
 public:
  // Divided into `parts` a side.
  ReceivingTriangle(const TriangleRecord& record, int parts);

  // Without the rim.
  Receiver piece(const WeightSquare& square) const;
  // True if the triangle is so narrow that rounding may have turned its plane; the cache does not
  // decide such triangles.
  bool isSliver() const { return sliver_; }
  double longest() const { return longest_; }  // of its edges

 private:
  std::array<Vec3d, 3> corner_;
  std::array<double, 3> size_{};  // of their coordinates, without signs: the sum
  double rim_, longest_;
  bool sliver_;
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

  simd::ShaftSides sides_;
  double reach_;
};

}  // namespace whit
