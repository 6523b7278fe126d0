#include "bake/facet.h"

#include <algorithm>
#include <cmath>

namespace whit {

namespace {

bool isInPlaneOf(const Facet& a, const Facet& b, double slack) {
  return std::all_of(b.corners.begin(), b.corners.end(), [&](const Vec3d& corner) {
    return std::abs(dot(corner - a.corners[0], a.normal)) <= slack;
  });
}

struct Interval {
  double lower, upper;
};

Interval extentOf(const Facet& facet, const Vec3d& origin, const Vec3d& axis) {
  const auto& [p, q, r] = facet.corners;
  const double x = dot(p - origin, axis), y = dot(q - origin, axis), z = dot(r - origin, axis);
  return {std::min({x, y, z}), std::max({x, y, z})};
}

// True if every strip along an edge of `a` that holds both triangles' common part is wider than
// `width`. With a `width` below zero: no edge leaves a gap as wide as that.
bool haveInCommon(const Facet& a, const Facet& b, double width) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d& origin = a.corners[i];
    const Vec3d axis = cross(a.normal, a.corners[(i + 1) % 3] - origin);
    const Interval own = extentOf(a, origin, axis), other = extentOf(b, origin, axis);
    const double common = std::min(own.upper, other.upper) - std::max(own.lower, other.lower);
    if (!(common > width * length(axis))) return false;
  }
  return true;
}

}  // namespace

double magnitudeOf(const Vec3d& point, const Affine* toWorld) {
  const Vec3d size = abs(point);
  if (!toWorld) return size.x + size.y + size.z;
  const Vec3d carried = abs(toWorld->x) * size.x + abs(toWorld->y) * size.y +
                        abs(toWorld->z) * size.z + abs(toWorld->p);
  return carried.x + carried.y + carried.z;
}

void setCorners(const TriangleRecord& triangle, const Affine* toWorld, Facet& facet) {
  double magnitude = 0;
  for (int i = 0; i < 3; ++i) {
    const float* p = triangle.position + 3 * i;
    magnitude = std::max(magnitude, magnitudeOf({p[0], p[1], p[2]}, toWorld));
  }
  facet.corners = cornersOf(triangle, toWorld);
  const auto& [a, b, c] = facet.corners;
  const Vec3d normal = cross(b - a, c - a);
  const double size = length(normal);
  facet.normal = size > 0 ? normal / size : Vec3d{};
  facet.error = facet.least = kErrorOfMagnitude * magnitude;
}

bool lieInOnePlane(const Facet& a, const Facet& b) {
  const double slack = a.error + b.error;
  return isInPlaneOf(a, b, slack) && isInPlaneOf(b, a, slack);
}

bool facetsOverlap(const Facet& a, const Facet& b) {
  const double width = a.least + b.least;
  return haveInCommon(a, b, width) && haveInCommon(b, a, width);
}

bool isTooNarrowToOverlap(const Facet& facet) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d& origin = facet.corners[i];
    const Vec3d axis = cross(facet.normal, facet.corners[(i + 1) % 3] - origin);
    const Interval own = extentOf(facet, origin, axis);
    if (!(own.upper - own.lower > facet.least * length(axis))) return true;
  }
  return false;
}

bool facetsTouch(const Facet& a, const Facet& b) {
  const double gap = -(a.error + b.error);
  return haveInCommon(a, b, gap) && haveInCommon(b, a, gap);
}

}  // namespace whit
