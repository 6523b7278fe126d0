// Affine maps of space: p -> linear part * p + translation. Kept in double while scenes are built,
// so that chains of transforms do not lose bits before the geometry is rounded once to float.
#pragma once

#include "core/vec3.h"

namespace whit {

struct Affine {
  Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  // images of the unit vectors (columns)
  Vec3d p{0, 0, 0};                          // image of the origin

  Vec3d vector(const Vec3d& v) const { return x * v.x + y * v.y + z * v.z; }
  Vec3d point(const Vec3d& v) const { return vector(v) + p; }
  double determinant() const { return dot(x, cross(y, z)); }
  bool operator==(const Affine&) const = default;

  // (a * b) applies b first.
  Affine operator*(const Affine& b) const {
    return {vector(b.x), vector(b.y), vector(b.z), point(b.p)};
  }

  // Cofactors: maps normals, up to length, and keeps them on the side of a mirrored surface. Works
  // for singular maps too (gives zero where no normal exists).
  Vec3d normal(const Vec3d& n) const {
    const double sign = determinant() < 0 ? -1.0 : 1.0;
    return (cross(y, z) * n.x + cross(z, x) * n.y + cross(x, y) * n.z) * sign;
  }

  static Affine translation(const Vec3d& t) { return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, t}; }
  static Affine scaling(const Vec3d& s) { return {{s.x, 0, 0}, {0, s.y, 0}, {0, 0, s.z}, {}}; }
  // Right-handed rotation by `degrees` about `axis` (any length above zero).
  static Affine rotation(const Vec3d& axis, double degrees) {
    const Vec3d a = normalized(axis, Vec3d{0, 1, 0});
    const double r = degrees * 3.14159265358979323846 / 180.0, c = std::cos(r), s = std::sin(r);

    // Rodrigues' formula gives the image of a unit vector e under the rotation.
    const auto column = [&](const Vec3d& e) {
      return e * c + cross(a, e) * s + a * (dot(a, e) * (1 - c));
    };

    return {column({1, 0, 0}), column({0, 1, 0}), column({0, 0, 1}), {}};
  }
};

// Maps magnitudes to upper bounds on those of the images.
inline Affine abs(const Affine& map) { return {abs(map.x), abs(map.y), abs(map.z), abs(map.p)}; }

}  // namespace whit
