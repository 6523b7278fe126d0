#include "reference/triangle.h"

#include <cmath>

namespace whit::reference {

namespace {

// A corner seen from the ray's origin, in axes in which the ray runs along z at speed 1. Rounded
// here and never again, corner by corner, so that all triangles see a shared corner in one place.
struct Sheared {
  double x = 0, y = 0, z = 0;
};

class RaySpace {
 public:
  explicit RaySpace(const Ray& ray) : origin_(ray.origin) {
    const Vec3d size = abs(ray.direction);
    z_ = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    x_ = (z_ + 1) % 3;
    y_ = (z_ + 2) % 3;
    slopeX_ = ray.direction[x_] / ray.direction[z_];
    slopeY_ = ray.direction[y_] / ray.direction[z_];
    speed_ = ray.direction[z_];
  }

  Sheared operator()(const Vec3d& corner) const {
    const Vec3d p = corner - origin_;
    return {p[x_] - slopeX_ * p[z_], p[y_] - slopeY_ * p[z_], p[z_] / speed_};
  }

 private:
  Vec3d origin_;
  int x_ = 0, y_ = 1, z_ = 2;
  double slopeX_ = 0, slopeY_ = 0, speed_ = 1;
};

// Twice the signed area between the ray and the edge from p to q. Rounding can make it 0, but never
// give it the wrong sign, because the two products are rounded monotonically.
double edgeSide(const Sheared& p, const Sheared& q) { return p.x * q.y - p.y * q.x; }

struct Pierced {
  TriangleHit hit;
  bool inside = false;
};

std::optional<Pierced> pierce(const Ray& ray, const Corners& corners) {
  const RaySpace toRaySpace(ray);
  const Sheared a = toRaySpace(corners[0]), b = toRaySpace(corners[1]), c = toRaySpace(corners[2]);
  const double w0 = edgeSide(b, c), w1 = edgeSide(c, a), w2 = edgeSide(a, b), sum = w0 + w1 + w2;
  if (sum == 0) return std::nullopt;
  const TriangleHit hit{(w0 * a.z + w1 * b.z + w2 * c.z) / sum, w1 / sum, w2 / sum};
  if (!std::isfinite(hit.t) || !std::isfinite(hit.u) || !std::isfinite(hit.v)) return std::nullopt;
  const bool inside = (w0 >= 0 && w1 >= 0 && w2 >= 0) || (w0 <= 0 && w1 <= 0 && w2 <= 0);
  return Pierced{hit, inside};
}

}  // namespace

std::optional<TriangleHit> piercePlane(const Ray& ray, const Corners& corners) {
  const std::optional<Pierced> pierced = pierce(ray, corners);
  return pierced ? std::optional(pierced->hit) : std::nullopt;
}

std::optional<TriangleHit> intersectTriangle(const Ray& ray, const Corners& corners) {
  const std::optional<Pierced> pierced = pierce(ray, corners);
  if (!pierced || !pierced->inside || !(pierced->hit.t > 0)) return std::nullopt;
  return pierced->hit;
}

}  // namespace whit::reference
