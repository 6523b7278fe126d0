#include "scene/facet.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

// Whether every strip along an edge of `a` that holds both triangles' common part is wider than
// `width`. Below zero: no edge leaves a gap as wide as that.
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

bool facetsTouch(const Facet& a, const Facet& b) {
  const double gap = -(a.error + b.error);
  return haveInCommon(a, b, gap) && haveInCommon(b, a, gap);
}

WeightRange weightsOf(const Facet& on, const Facet& of) {
  // Of rays' hits, whose weights are floats.
  constexpr double kRounding = 0x1p-12;
  const Vec3d e1 = on.corners[1] - on.corners[0], e2 = on.corners[2] - on.corners[0];
  const double area = dot(cross(e1, e2), on.normal);
  // A weight grows along the normal of the edge that faces its corner.
  const Vec3d growthU = cross(e2, on.normal) / area, growthV = cross(on.normal, e1) / area;
  const double slack = on.error + of.error;
  const double slackU = kRounding + slack * length(growthU),
               slackV = kRounding + slack * length(growthV);
  constexpr double kFar = std::numeric_limits<double>::infinity();
  double u0 = kFar, u1 = -kFar, v0 = kFar, v1 = -kFar;
  for (const Vec3d& corner : of.corners) {
    const double u = dot(corner - on.corners[0], growthU), v = dot(corner - on.corners[0], growthV);
    u0 = std::min(u0, u), u1 = std::max(u1, u);
    v0 = std::min(v0, v), v1 = std::max(v1, v);
  }
  const auto bounded = [](double weight) {
    return static_cast<float>(std::clamp(weight, -1.0, 2.0));
  };
  return {bounded(u0 - slackU), bounded(u1 + slackU), bounded(v0 - slackV), bounded(v1 + slackV)};
}

}  // namespace whit
