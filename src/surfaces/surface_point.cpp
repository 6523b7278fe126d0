#include "surfaces/surface_point.h"

#include <algorithm>
#include <optional>

#include "bake/sphere.h"

namespace whit {

namespace {

// The magnitudes that the hit point is added up from, per axis.
Vec3d magnitudeOnTriangle(const TriangleRecord& t, const TriangleHit& hit) {
  const double w = std::max(0.0, 1 - hit.u - hit.v);
  return abs(triple(t.position)) * w + abs(triple(t.position + 3)) * hit.u +
         abs(triple(t.position + 6)) * hit.v;
}

double sumOf(const Vec3d& v) { return v.x + v.y + v.z; }

// True if the triangle is so narrow that its normal may be turned by rounding to float.
bool isNarrow(const Edges& e) {
  const Vec3d area = abs(cross(e.e1, e.e2));
  return sumOf(area) <= 0x1p-14 * sumOf(abs(e.e1)) * sumOf(abs(e.e2));
}

// The inputs of a position, in the space of the geometry.
struct Placement {
  Vec3d position, magnitude;
  Vec3d spans;    // along the edges, or of a sphere kSphereSpan of its axes
  Vec3d inPlane;  // some point of the triangle's plane, or of the one that touches the sphere
  Vec3d normal;   // on the outside, of any length
  bool isNarrow = false;
};

Placement placementOnTriangle(const TriangleRecord& triangle, const TriangleHit& hit) {
  const Edges e = edgesOf(triangle);
  return {interpolate(triangle.position, hit),
          magnitudeOnTriangle(triangle, hit),
          abs(e.e1) + abs(e.e2),
          triple(triangle.position),
          cross(e.e1, e.e2),
          isNarrow(e)};
}

Placement placementOnSphere(const TriangleRecord& sphere, const TriangleHit& hit) {
  const Affine own = sphereMap(sphere);
  const Vec3d unit = spherePoint(hit.u, hit.v), point = own.point(unit);
  const Vec3d spans = abs(own).vector(Vec3d(double{kSphereSpan}));
  return {point, abs(own).point(abs(unit)), spans, point, own.normal(unit)};
}

// Returns the point where the ray hits the triangle's plane if it is more precise than the point
// that the weights give. It is where a triangle is larger than its distance from the ray's start,
// because the weights of a hit were found in floats.
std::optional<Vec3d> pointOnRay(const Placement& place, double t, const Ray& ray,
                                const Vec3d& normal) {
  if (!(8 * t < sumOf(place.spans))) return std::nullopt;
  const Vec3d point = ray.origin + ray.direction * t;
  return point - normal * dot(point - place.inPlane, normal);
}

// The position, and how far from it rays start, in the arithmetic of floats. The bound on the
// distance between the plane as Embree computes it and the start has three parts. The products that
// a point is added up from are rounded by an ulp or two of themselves along each axis (pbrt-v4,
// section 6.8.5). Embree subtracts a ray's origin from the corners and takes t from products of
// those differences, so its plane is off by some ulps of the edges. Only what these errors
// contribute along the normal counts, plus 2^-6 of an ulp of everything, because a start must not
// lie in the plane and the normal is rounded as well. Near the origin of a large triangle the
// second part is the largest by far, so no bound may rest on the point's coordinates alone.
// Across the normal the point is off as well. The offset towards the viewer makes up for that: half
// of the way that the ray has come is known to be clear. Where the errors of several axes mix, as
// they do in an instance's space and where other surfaces lie in the same place (`inDoubt`), all of
// them count.
void findStart(const Placement& place, double t, const Ray& ray, const Affine* toWorld,
               bool inDoubt, SurfacePoint& s) {
  s.position = place.position;
  Vec3d point = place.magnitude, edges = place.spans;
  if (toWorld) {
    s.position = toWorld->point(s.position);
    point = abs(*toWorld).point(point);
    edges = abs(*toWorld).vector(edges);
  }

  const Vec3d n = abs(s.geometricNormal);
  s.offset = kUnitRoundOff * (32 * sumOf(point) + 16 * sumOf(edges));
  s.viewOffset = std::min(s.offset, t) / 2;
  if (inDoubt || toWorld || place.isNarrow) return;

  double across = sumOf(point * 2.0 + edges);
  if (const auto onRay = pointOnRay(place, t, ray, s.geometricNormal)) {
    s.position = *onRay;
    across = 2 * sumOf(abs(s.position)) + 8 * t + 2 * dot(n, edges);
  }

  const double along = 4 * dot(n, point) + 16 * dot(n, edges) + sumOf(point + edges) / 64;
  s.offset = kUnitRoundOff * along;
  s.viewOffset = std::min(s.viewOffset, kUnitRoundOff * across);
}

}  // namespace

SurfacePoint surfacePoint(const Scene& scene, const Candidate& candidate, const TriangleHit& hit,
                          const Ray& ray, bool sharesPlace) {
  const TriangleRecord& record = scene.triangles[candidate.triangle];
  const Affine* toWorld = toWorldOf(scene, candidate.instance);
  const Placement place = scene.isSphere(candidate.triangle) ? placementOnSphere(record, hit)
                                                             : placementOnTriangle(record, hit);

  SurfacePoint s;
  const Vec3d normal = toWorld ? toWorld->normal(place.normal) : place.normal;
  s.geometricNormal = normalized(normal, -ray.direction);
  findStart(place, hit.t, ray, toWorld, sharesPlace, s);

  s.entering = dot(ray.direction, s.geometricNormal) < 0;
  if (!s.entering) s.geometricNormal = -s.geometricNormal;
  return s;
}

}  // namespace whit
