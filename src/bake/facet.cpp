#include "bake/facet.h"

#include <algorithm>
#include <cmath>

#include "bake/sphere.h"
#include "core/index.h"

namespace whit {

namespace {

bool lieInOnePlane(const Facet& a, const Facet& b) {
  const double slack = a.error + b.error;
  const auto isInPlaneOf = [slack](const Facet& own, const Facet& other) {
    return std::ranges::all_of(other.corners, [&](const Vec3d& corner) {
      return std::abs(dot(corner - own.corners[0], own.normal)) <= slack;
    });
  };
  return a.normal != Vec3d{} && b.normal != Vec3d{} && isInPlaneOf(a, b) && isInPlaneOf(b, a);
}

struct Interval {
  double lower, upper;
};

Interval extentOf(const Facet& facet, const Vec3d& origin, const Vec3d& axis) {
  const auto& [p, q, r] = facet.corners;
  const double x = dot(p - origin, axis), y = dot(q - origin, axis), z = dot(r - origin, axis);
  return {std::min({x, y, z}), std::max({x, y, z})};
}

// True if every strip along an edge of either that holds the triangles' common part is wider than
// `width`. With a `width` below zero: no edge leaves a gap as wide as that.
bool haveInCommon(const Facet& a, const Facet& b, double width) {
  // Separating axis test in the plane: the axes are the normals of all six edges.
  for (const Facet* facet : {&a, &b}) {
    for (const auto i : indices(3)) {
      const Vec3d& origin = facet->corners[i];
      const Vec3d axis = cross(facet->normal, facet->corners[(i + 1) % 3] - origin);
      const Interval own = extentOf(a, origin, axis), other = extentOf(b, origin, axis);
      const double common = std::min(own.upper, other.upper) - std::max(own.lower, other.lower);
      if (!(common > width * length(axis))) return false;
    }
  }
  return true;
}

// The weights of corners 1 and 2 of a triangle.
struct Weights {
  double u, v;
};

// Edges that are moved outwards: a point that lies in the triangle lies inside of all of them, even
// if its weights are off by as much as `off`.
std::array<CoveredPart::Edge, 3> edgesAround(const std::array<Weights, 3>& corners,
                                             const Weights& off) {
  constexpr double kRounding = 0x1p-20;  // relative error of the sum in floats
  std::array<CoveredPart::Edge, 3> edges;
  for (const auto i : indices(3)) {
    // The line through corners p and q is a * u + b * v + c = 0.
    const Weights &p = corners[i], &q = corners[(i + 1) % 3], &opposite = corners[(i + 2) % 3];
    double a = p.v - q.v, b = q.u - p.u, c = p.u * q.v - p.v * q.u;

    // The sign of `size` makes the third corner's side the positive one.
    const double inside = a * opposite.u + b * opposite.v + c;
    const double size = std::copysign(std::max({std::abs(a), std::abs(b), std::abs(c)}), inside);
    // An edge whose inner side is lost in rounding has nothing outside.
    if (!(std::abs(inside) > kRounding * std::abs(size))) continue;

    a /= size;
    b /= size;
    c /= size;
    c += std::abs(a) * off.u + std::abs(b) * off.v + 3 * kRounding;
    edges[i] = {static_cast<float>(a), static_cast<float>(b), static_cast<float>(c)};
  }
  return edges;
}

// Rounding of the eye's coordinates: at most four units in the last place of the largest.
double roundingOf(const Vec3d& eye) {
  const Vec3d size = abs(eye);
  return 0x1p-22 * (size.x + size.y + size.z);
}

}  // namespace

Corners cornersOf(const TriangleRecord& triangle, const Affine* toWorld) {
  const float* p = triangle.position;
  Corners corners{Vec3d(p[0], p[1], p[2]), Vec3d(p[3], p[4], p[5]), Vec3d(p[6], p[7], p[8])};
  if (!toWorld) return corners;
  for (Vec3d& corner : corners) corner = toWorld->point(corner);
  return corners;
}

Corners worldCorners(const Scene& scene, std::uint32_t triangle, std::uint32_t instance) {
  return cornersOf(scene.triangles[triangle], toWorldOf(scene, instance));
}

double magnitudeOf(const Vec3d& point, const Affine* toWorld) {
  const Vec3d size = toWorld ? abs(*toWorld).point(abs(point)) : abs(point);
  return size.x + size.y + size.z;
}

Facet facetOf(const TriangleRecord& triangle, const Affine* toWorld) {
  Facet facet;
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
  return facet;
}

Facet facetOf(const Scene& scene, PlacedTriangleId id) {
  return facetOf(scene.triangles[id.triangle], toWorldOf(scene, id.instance));
}

bool facetsOverlap(const Facet& a, const Facet& b) {
  return lieInOnePlane(a, b) && haveInCommon(a, b, a.least + b.least);
}

bool facetsTouch(const Facet& a, const Facet& b) {
  return lieInOnePlane(a, b) && haveInCommon(a, b, -(a.error + b.error));
}

double leastAltitude(const Facet& facet) {
  const auto& [a, b, c] = facet.corners;
  const Vec3d ab = b - a, bc = c - b, ca = a - c;
  const double longest = std::sqrt(std::max({dot(ab, ab), dot(bc, bc), dot(ca, ca)}));
  return dot(cross(ca, ab), facet.normal) / longest;
}

// Two triangles have no part in common that is wider than either of them.
bool isTooNarrowToOverlap(const Facet& facet) {
  constexpr double kBeyondRounding = 1.001;
  if (leastAltitude(facet) > kBeyondRounding * facet.least) return false;
  return !haveInCommon(facet, facet, facet.least);
}

CoveredPart coveredPart(const Facet& on, const Facet& of) {
  // Rounding of the hits' weights, which are floats.
  constexpr double kRounding = 0x1p-12;

  const Vec3d e1 = on.corners[1] - on.corners[0], e2 = on.corners[2] - on.corners[0];
  const double area = dot(cross(e1, e2), on.normal);
  // The gradient of a weight is perpendicular to the edge that faces its corner.
  const Vec3d growthU = cross(e2, on.normal) / area, growthV = cross(on.normal, e1) / area;

  // A weight may be off by its own rounding and by the error of the positions.
  const double slack = on.error + of.error;
  const Weights off = {kRounding + slack * length(growthU), kRounding + slack * length(growthV)};

  std::array<Weights, 3> corners;
  for (const auto i : indices(3)) {
    const Vec3d from = of.corners[i] - on.corners[0];
    corners[i] = {dot(from, growthU), dot(from, growthV)};
  }

  const auto [u0, u1] = std::minmax({corners[0].u, corners[1].u, corners[2].u});
  const auto [v0, v1] = std::minmax({corners[0].v, corners[1].v, corners[2].v});

  // Weights of hits are between 0 and 1, so bounds far outside of this need no precision.
  const auto bounded = [](double weight) {
    return static_cast<float>(std::clamp(weight, -1.0, 2.0));
  };
  return {bounded(u0 - off.u), bounded(u1 + off.u),       bounded(v0 - off.v),
          bounded(v1 + off.v), edgesAround(corners, off), facetsOverlap(on, of)};
}

bool liesInPlane(const Vec3d& eye, const Corners& corners) {
  const Vec3d n = cross(corners[1] - corners[0], corners[2] - corners[0]);
  return std::fabs(dot(n, eye - corners[0])) <= roundingOf(eye) * length(n);
}

bool liesInSurface(const Scene& scene, const Vec3d& eye, std::uint32_t number,
                   std::uint32_t instance) {
  if (!scene.isSphere(number)) return liesInPlane(eye, worldCorners(scene, number, instance));

  const Affine map = sphereInWorld(scene, {number, instance});
  const Vec3d unit = onUnitSphere(map, eye), direction = normalized(unit);
  // The map stretches distances along the normal of its surface by this factor.
  const double stretch = std::fabs(map.determinant()) / length(map.normal(direction));
  return std::fabs(length(unit) - 1) * stretch <= roundingOf(eye);
}

double distancePastEye(const Vec3d& eye, int attempt) {
  constexpr double kLeast = 1e-30;  // a product with it still is a float
  return std::ldexp(std::max(roundingOf(eye), kLeast), attempt);
}

}  // namespace whit
