// A box along the axes, grown around points.
#pragma once

#include <limits>

#include "core/vec3.h"

namespace whit {

struct Box {
  Vec3f lower{std::numeric_limits<float>::max()}, upper{std::numeric_limits<float>::lowest()};

  bool empty() const { return !(lower.x <= upper.x); }
  void add(const Vec3f& p) {
    lower = min(lower, p);
    upper = max(upper, p);
  }
  double diagonal() const { return length(Vec3d(upper) - Vec3d(lower)); }
  Vec3d center() const { return (Vec3d(lower) + Vec3d(upper)) * 0.5; }
  // Corner i of eight: bit k of `i` chooses the lower or the upper end of axis k.
  Vec3f corner(int i) const {
    return {i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z};
  }
};

}  // namespace whit
