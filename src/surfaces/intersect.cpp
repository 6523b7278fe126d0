#include "surfaces/intersect.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace whit {

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

// The nearest weights that belong to a point of the triangle.
void moveOntoTriangle(TriangleHit& hit) {
  const double w = std::max(0.0, 1 - hit.u - hit.v);
  const double u = std::max(0.0, hit.u), v = std::max(0.0, hit.v);
  const double sum = w + u + v;
  hit.u = sum > 0 ? u / sum : 1.0 / 3;
  hit.v = sum > 0 ? v / sum : 1.0 / 3;
}

// A hit on a sphere, which has two: that nearest to the point that the weights name.
TriangleHit refineSphereHit(const Scene& scene, const Ray& ray, const Candidate& candidate) {
  const Affine map = sphereInWorld(scene, {candidate.triangle, candidate.instance});

  const Vec3d there = map.point(spherePoint(candidate.u, candidate.v));
  const double squared = dot(ray.direction, ray.direction);
  const double hint = dot(there - ray.origin, ray.direction) / squared;

  TriangleHit best{hint > 0 ? hint : std::numeric_limits<double>::min(), candidate.u, candidate.v};
  double least = kInfinity;

  // The weights name a point, and the nearer of the two hits is kept.
  for (const TriangleHit& hit : intersectSphere(ray, map)) {
    const double off = std::fabs(hit.t - hint);
    if (!(off < least)) continue;
    least = off;
    best = hit;
  }
  return best;
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

TriangleHit refineHit(const Scene& scene, const Ray& ray, const Candidate& candidate) {
  if (scene.isSphere(candidate.triangle)) return refineSphereHit(scene, ray, candidate);
  const Corners corners = worldCorners(scene, candidate.triangle, candidate.instance);
  if (std::optional<TriangleHit> hit = piercePlane(ray, corners); hit && hit->t > 0) {
    moveOntoTriangle(*hit);
    return *hit;
  }
  TriangleHit hit{0, candidate.u, candidate.v};
  moveOntoTriangle(hit);
  const Vec3d point = corners[0] * (1 - hit.u - hit.v) + corners[1] * hit.u + corners[2] * hit.v;
  const double t = dot(point - ray.origin, ray.direction) / dot(ray.direction, ray.direction);
  hit.t = t > 0 ? t : std::numeric_limits<double>::min();
  return hit;
}

Edges edgesOf(const TriangleRecord& triangle) {
  const Vec3d p0 = triple(triangle.position);
  return {triple(triangle.position + 3) - p0, triple(triangle.position + 6) - p0};
}

Vec3d outwardNormal(const Scene& scene, std::uint32_t triangle, std::uint32_t instance) {
  const Edges e = edgesOf(scene.triangles[triangle]);
  const Vec3d normal = cross(e.e1, e.e2);
  const Affine* toWorld = toWorldOf(scene, instance);
  return toWorld ? toWorld->normal(normal) : normal;
}

}  // namespace whit
