#include "reference/intersect.h"

#include <cmath>

namespace whit::reference {

namespace {

struct Pierced {
  TriangleHit hit;
  bool inside = false;
};

std::optional<Pierced> pierce(const Ray& ray, const Corners& corners) {
  const int z = largestAxis(abs(ray.direction));
  const int x = (z + 1) % 3, y = (z + 2) % 3;
  const double speed = ray.direction[z];
  const double slopeX = ray.direction[x] / speed, slopeY = ray.direction[y] / speed;

  // A corner seen from the ray's origin, in axes in which the ray runs along z at speed 1. It is
  // rounded here and never again, so that all triangles see a shared corner in one place.
  const auto sheared = [&](const Vec3d& corner) {
    const Vec3d p = corner - ray.origin;
    return Vec3d{p[x] - slopeX * p[z], p[y] - slopeY * p[z], p[z] / speed};
  };

  // Twice the signed area between the ray and the edge from p to q. Rounding can make it 0, but
  // never give it the wrong sign, because the two products are rounded monotonically.
  const auto edgeSide = [](const Vec3d& p, const Vec3d& q) { return p.x * q.y - p.y * q.x; };

  const Vec3d a = sheared(corners[0]), b = sheared(corners[1]), c = sheared(corners[2]);
  const double w0 = edgeSide(b, c), w1 = edgeSide(c, a), w2 = edgeSide(a, b), sum = w0 + w1 + w2;
  if (sum == 0) return std::nullopt;
  const TriangleHit hit{(w0 * a.z + w1 * b.z + w2 * c.z) / sum, w1 / sum, w2 / sum};
  if (!std::isfinite(hit.t) || !std::isfinite(hit.u) || !std::isfinite(hit.v)) return std::nullopt;

  // The ray passes through the triangle, border included, if it is on one side of all edges.
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
