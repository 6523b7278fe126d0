#include "reference/triangle.h"

#include <cmath>
#include <limits>

namespace whit::reference {

namespace {

// Six times the signed volume that the ray's direction spans with the edge from p to q, both seen
// from the ray's origin. Swapping p and q changes the sign and nothing else, not even a bit.
double edgeSide(const Vec3d& p, const Vec3d& q, const Vec3d& direction) {
  return dot(cross(q - p, p + q), direction);
}

// Weights of the corners, not yet divided by their sum.
struct Weights {
  double w0 = 0, w1 = 0, w2 = 0;
  bool sameSign() const {
    return (w0 >= 0 && w1 >= 0 && w2 >= 0) || (w0 <= 0 && w1 <= 0 && w2 <= 0);
  }
};

Weights weightsOf(const Ray& ray, const Corners& corners) {
  const Vec3d a = corners[0] - ray.origin, b = corners[1] - ray.origin, c = corners[2] - ray.origin;
  return {edgeSide(b, c, ray.direction), edgeSide(c, a, ray.direction),
          edgeSide(a, b, ray.direction)};
}

std::optional<TriangleHit> pierceWith(const Weights& weights, const Ray& ray,
                                      const Corners& corners) {
  const double sum = weights.w0 + weights.w1 + weights.w2;
  const Vec3d normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double approach = dot(normal, ray.direction);
  if (sum == 0 || approach == 0) return std::nullopt;
  const TriangleHit hit{dot(normal, corners[0] - ray.origin) / approach, weights.w1 / sum,
                        weights.w2 / sum};
  if (!std::isfinite(hit.t) || !std::isfinite(hit.u) || !std::isfinite(hit.v)) return std::nullopt;
  return hit;
}

// The nearest weights that belong to a point of the triangle.
void moveOntoTriangle(TriangleHit& hit) {
  const double w = std::max(0.0, 1 - hit.u - hit.v);
  const double u = std::max(0.0, hit.u), v = std::max(0.0, hit.v);
  const double sum = w + u + v;
  hit.u = sum > 0 ? u / sum : 1.0 / 3;
  hit.v = sum > 0 ? v / sum : 1.0 / 3;
}

}  // namespace

Corners worldCorners(const Scene& scene, std::uint32_t triangle, std::uint32_t instance) {
  const float* p = scene.triangles[triangle].position;
  Corners corners{Vec3d(p[0], p[1], p[2]), Vec3d(p[3], p[4], p[5]), Vec3d(p[6], p[7], p[8])};
  if (instance != kNoHit) {
    for (Vec3d& corner : corners) corner = scene.instances[instance].toWorld.point(corner);
  }
  return corners;
}

std::optional<TriangleHit> piercePlane(const Ray& ray, const Corners& corners) {
  return pierceWith(weightsOf(ray, corners), ray, corners);
}

std::optional<TriangleHit> intersectTriangle(const Ray& ray, const Corners& corners) {
  const Weights weights = weightsOf(ray, corners);
  if (!weights.sameSign()) return std::nullopt;
  const std::optional<TriangleHit> hit = pierceWith(weights, ray, corners);
  return hit && hit->t > 0 ? hit : std::nullopt;
}

TriangleHit refineHit(const Scene& scene, const Ray& ray, const Candidate& candidate) {
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

}  // namespace whit::reference
