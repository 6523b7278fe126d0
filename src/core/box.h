// A box along the axes, grown around points.
#pragma once

#include <limits>

#include "core/vec3.h"

namespace whit {

template <typename Vector>
struct BoxOf {
  using Limits = std::numeric_limits<decltype(Vector::x)>;
  Vector lower{Limits::max()}, upper{Limits::lowest()};

  bool empty() const { return !(lower.x <= upper.x); }
  void add(const Vector& p) {
    lower = min(lower, p);
    upper = max(upper, p);
  }
  double diagonal() const { return length(Vec3d(upper) - Vec3d(lower)); }
  Vec3d center() const { return (Vec3d(lower) + Vec3d(upper)) * 0.5; }
  Vector half() const { return (upper - lower) * 0.5; }
  // Corner i of eight: bit k of `i` chooses the lower or the upper end of axis k.
  Vector corner(int i) const {
    return {i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z};
  }
};
using Box = BoxOf<Vec3f>;

}  // namespace whit
