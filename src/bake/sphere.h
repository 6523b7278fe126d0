// Exact spheres: images of the unit sphere about the origin by affine maps, so ellipsoids too. They
// share the numbers of triangles, from Scene::firstSphere on. The two weights of a hit identify a
// point of the unit sphere, so that position, normal and texture coordinates follow from number and
// weights, as on a triangle.
#pragma once

#include <array>
#include <optional>

#include "bake/scene.h"
#include "core/affine.h"
#include "core/vec3.h"

namespace whit {

// Layout of the 64 bytes of a TriangleRecord that is a sphere.
struct alignas(64) SphereRecord {
  float axes[9];  // images of the unit vectors, one after the other
  float center[3];
  float outward;  // -1 where the map mirrors, else 1: times the cofactors, they carry normals
  float spare[2];
  std::uint32_t material;
};
static_assert(sizeof(SphereRecord) == sizeof(TriangleRecord));

TriangleRecord makeSphereRecord(const Affine& toGeometry, std::uint32_t material);
// Returns the map from the unit sphere to the space of the geometry.
Affine sphereMap(const TriangleRecord& record);
// Returns the map from the unit sphere to the world.
Affine sphereInWorld(const Scene& scene, PlacedTriangleId sphere);
// Returns the rows of the linear part of the map's inverse; multiply() is their product with a
// vector.
std::array<Vec3d, 3> inverseRows(const Affine& map);
Vec3d multiply(const std::array<Vec3d, 3>& rows, const Vec3d& v);
// Returns bounds of the image of the unit sphere, rounded outwards.
Box sphereBounds(const Affine& map);

// The two weights are an octahedral map of the unit sphere (Cigolle et al. 2014, "A Survey of
// Efficient Representations for Independent Unit Vectors"), drawn into a triangle and away from its
// edges: nothing that looks for hits near a triangle's edge finds one.
inline constexpr double kSphereWeightBegin = 0x1p-11, kSphereWeightScale = 1.0 / 8;
std::array<double, 2> sphereWeights(const Vec3d& unit);
Vec3d spherePoint(double u, double v);

// Returns the texture coordinates of a point of the unit sphere: u turns about y from +x towards
// -z, v rises from the lower pole to the upper one.
std::array<double, 2> sphereUv(const Vec3d& unit);
// Returns the first texture coordinates of a hit on a triangle or a sphere.
Vec2f uvAt(const Scene& scene, std::uint32_t number, double u, double v);

// Returns a triangle that touches the sphere at the point, which is its first corner and is moved
// to the origin. Texture coordinates grow along its edges as they do on the sphere.
TriangleRecord touchingTriangle(const TriangleRecord& sphere, double u, double v);
// Factor from the extent of a sphere, the images of the unit vectors summed per axis, to the edge
// length that the error bound of a position uses for triangles.
inline constexpr float kSphereSpan = 0.25f;
// Length of the edges in texture coordinates.
inline constexpr float kTouchingEdge = 0x1p-4f;
// Nearer to the axis than this, u grows as it does here: at a pole it has no direction.
inline constexpr float kPoleRadius = 0x1p-10f;

// Intersections of a line with the sphere, in lengths of its direction, ascending. They are
// computed without cancellation: Haines et al. 2019, "Precision Improvements for Ray/Sphere
// Intersection", Ray Tracing Gems, chapter 7.
struct SphereRoots {
  double near = 0, far = 0;
};
std::optional<SphereRoots> meetSphere(const Affine& fromUnit, const Vec3d& origin,
                                      const Vec3d& direction);
// Applies the inverse of the map to a point.
Vec3d onUnitSphere(const Affine& fromUnit, const Vec3d& point);

}  // namespace whit
