// Where shadow rays start: a piece of a triangle, and how far from it rounding may have moved them.
#pragma once

#include <array>

#include "bake/scene.h"
#include "core/vec3.h"
#include "stages/shadow_cache_view.h"

namespace whit {

// A convex piece of a receiving triangle. All shadow rays with weights in it, within the kernel's
// reach (kCachedShadowReach), start no further than `reach` from it.
struct Receiver {
  // A square of weights, cut by the three edges.
  static constexpr std::size_t kMostCorners = 7;
  std::array<Vec3d, kMostCorners> corners;
  std::size_t count = 0;  // none: the piece lies in the rim
  double reach = 0;
  Vec3d center;
  double radius = 0;  // around it, of the corners

  void add(const Vec3d& corner) { corners[count++] = corner; }
};

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

}  // namespace whit
