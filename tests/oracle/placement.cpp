#include "oracle/placement.h"

#include <numbers>

namespace oracle {

namespace {

Vec turned(const Vec& v, const Transform& transform) {
  const Vec k = normalized(transform.axis);
  const double angle = transform.degrees * std::numbers::pi / 180;
  const double c = std::cos(angle), s = std::sin(angle);
  return v * c + cross(k, v) * s + k * (dot(k, v) * (1 - c));  // Rodrigues
}

}  // namespace

Vec placed(Vec point, std::span<const Transform> transforms) {
  for (std::size_t i = transforms.size(); i-- > 0;) {
    point = turned(point * transforms[i].scale, transforms[i]) + transforms[i].translate;
  }
  return point;
}

Vec placedDifference(Vec difference, std::span<const Transform> transforms) {
  for (std::size_t i = transforms.size(); i-- > 0;) {
    difference = turned(difference * transforms[i].scale, transforms[i]);
  }
  return difference;
}

Vec placedNormal(Vec n, std::span<const Transform> transforms) {
  for (std::size_t i = transforms.size(); i-- > 0;) {
    const Vec& s = transforms[i].scale;
    n = normalized(turned({n.x / s.x, n.y / s.y, n.z / s.z}, transforms[i]));
  }
  return n;
}

bool areMirroring(std::span<const Transform> transforms) {
  bool mirroring = false;
  for (const auto& [scale, axis, degrees, translate] : transforms) {
    mirroring = mirroring != (scale.x * scale.y * scale.z < 0);
  }
  return mirroring;
}

}  // namespace oracle
