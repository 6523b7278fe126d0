#include "oracle/faces.h"

#include <numbers>

#include "oracle/placement.h"

namespace oracle {

namespace {

void measureTexture(Triangle& triangle) {
  const auto& [a, b, c] = triangle.corners;
  const Vec e1 = b.position - a.position, e2 = c.position - a.position;
  const double u1 = b.uv[0] - a.uv[0], u2 = c.uv[0] - a.uv[0];
  const double v1 = b.uv[1] - a.uv[1], v2 = c.uv[1] - a.uv[1];
  const double area = u1 * v2 - u2 * v1;
  if (area == 0) return;

  triangle.alongU = (e1 * v2 - e2 * v1) / area;
  triangle.alongV = (e2 * u1 - e1 * u2) / area;
}

Vec inUnitSpace(const Vec& difference, const Sphere& sphere) {
  const auto& [x, y, z] = sphere.crossways;
  return {dot(x, difference), dot(y, difference), dot(z, difference)};
}

Vec inWorld(const Vec& difference, const Sphere& sphere) {
  const auto& [x, y, z] = sphere.axes;
  return x * difference.x + y * difference.y + z * difference.z;
}

// The point of the unit sphere is (rho cos 2 pi u, -cos pi v, -rho sin 2 pi u), rho = sin pi v. At
// a pole u has no direction: no random ray meets one.
Hit hitAt(const Vec& unit, double t, const Sphere& sphere) {
  constexpr double kPi = std::numbers::pi;
  const auto& [x, y, z] = unit;
  const double rho = std::hypot(x, z), turn = std::atan2(-z, x) / (2 * kPi);

  Hit hit;
  hit.t = t;
  hit.face = &sphere;
  const auto& [alongX, alongY, alongZ] = sphere.crossways;
  hit.outward = normalized(alongX * x + alongY * y + alongZ * z);  // by the inverse transpose

  hit.uv = {turn - std::floor(turn), std::acos(std::clamp(-y, -1.0, 1.0)) / kPi};
  hit.alongU = inWorld(Vec{z, 0, -x} * (2 * kPi), sphere);
  hit.alongV = inWorld(Vec{-y * x / rho, rho, -y * z / rho} * kPi, sphere);
  return hit;
}

}  // namespace

Triangle placedTriangle(const Mesh& mesh, const std::array<int, 3>& indices,
                        std::span<const Transform> transforms) {
  Triangle triangle;
  triangle.smooth = !mesh.normals.empty();
  for (std::size_t i = 0; i < 3; ++i) {
    const int index = indices[i];
    Corner& corner = triangle.corners[i];
    corner.position = placed(mesh.positions[index], transforms);
    if (triangle.smooth) corner.normal = placedNormal(mesh.normals[index], transforms);
    corner.color = mesh.colors.empty() ? gray(1) : mesh.colors[index];
    if (!mesh.uvs.empty()) corner.uv = mesh.uvs[index];
  }

  const auto& [a, b, c] = triangle.corners;
  const double mirrored = areMirroring(transforms) ? -1 : 1;
  triangle.outward = normalized(cross(b.position - a.position, c.position - a.position)) * mirrored;
  measureTexture(triangle);
  return triangle;
}

Sphere placedSphere(double radius, std::span<const Transform> transforms) {
  Sphere sphere;
  sphere.axes = {placedDifference({radius, 0, 0}, transforms),
                 placedDifference({0, radius, 0}, transforms),
                 placedDifference({0, 0, radius}, transforms)};
  const auto& [x, y, z] = sphere.axes;
  const double volume = dot(x, cross(y, z));
  sphere.crossways = {cross(y, z) / volume, cross(z, x) / volume, cross(x, y) / volume};
  sphere.center = placed({}, transforms);
  return sphere;
}

// Moeller and Trumbore 1997, "Fast, minimum storage ray/triangle intersection".
std::optional<Hit> meet(const Ray& ray, const Triangle& triangle) {
  const auto& [a, b, c] = triangle.corners;
  const Vec e1 = b.position - a.position, e2 = c.position - a.position;
  const Vec p = cross(ray.direction, e2);
  const double determinant = dot(e1, p);
  if (determinant == 0) return std::nullopt;

  const Vec from = ray.origin - a.position;
  const double u = dot(from, p) / determinant;
  if (u < 0 || u > 1) return std::nullopt;

  const Vec q = cross(from, e1);
  const double v = dot(ray.direction, q) / determinant;
  if (v < 0 || u + v > 1) return std::nullopt;

  const double w = 1 - u - v;
  Hit hit{dot(e2, q) / determinant, &triangle,       triangle.outward, {},
          triangle.alongU,          triangle.alongV, &triangle,        {w, u, v}};
  for (std::size_t i = 0; i < 2; ++i) hit.uv[i] = a.uv[i] * w + b.uv[i] * u + c.uv[i] * v;
  return hit;
}

// |from + direction t| = 1 in the space of the unit sphere.
std::vector<Hit> meet(const Ray& ray, const Sphere& sphere) {
  const Vec from = inUnitSpace(ray.origin - sphere.center, sphere);
  const Vec direction = inUnitSpace(ray.direction, sphere);
  const double a = dot(direction, direction), b = dot(from, direction);
  const double discriminant = b * b - a * (dot(from, from) - 1);
  if (!(discriminant > 0)) return {};

  const double root = std::sqrt(discriminant);
  std::vector<Hit> hits;
  for (const double t : {(-b - root) / a, (-b + root) / a}) {
    hits.push_back(hitAt(from + direction * t, t, sphere));
  }
  return hits;
}

}  // namespace oracle
