// What rays meet: triangles and exact spheres, in the world.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "oracle/scene.h"

namespace oracle {

// What a triangle and a sphere have of the scene.
struct Face {
  const Material* material = nullptr;
  int order = 0;  // in the file

  bool isOpaque() const { return !material->passesLight(); }
  // A face that is neither opaque nor a sheet bounds a dielectric.
  bool isSheet() const { return material->passesLight() && !material->isDielectric(); }
};

struct Corner {
  Vec position, normal;
  Color color;
  std::array<double, 2> uv{};
};

struct Triangle : Face {
  std::array<Corner, 3> corners;
  Vec outward;  // unit, of its plane
  // By how much it goes on where one texture coordinate grows by 1; 0 if none does.
  Vec alongU, alongV;
  bool smooth = false;
};

// The unit sphere about the origin, carried to the world: an ellipsoid.
struct Sphere : Face {
  std::array<Vec, 3> axes;       // what the unit vectors become
  std::array<Vec, 3> crossways;  // the rows of the inverse of the matrix of those columns
  Vec center;
};

struct Ray {
  Vec origin, direction;
};

struct Hit {
  double t = 0;  // in lengths of the direction
  const Face* face = nullptr;
  Vec outward;  // unit
  std::array<double, 2> uv{};
  Vec alongU, alongV;                  // as of a triangle
  const Triangle* triangle = nullptr;  // if it is one
  std::array<double, 3> weights{};     // of its corners
};

Triangle placedTriangle(const Mesh& mesh, const std::array<int, 3>& indices,
                        std::span<const Transform> transforms);
Sphere placedSphere(double radius, std::span<const Transform> transforms);

std::optional<Hit> meet(const Ray& ray, const Triangle& triangle);
// Where the ray, or what would come before it, goes in and where it goes out.
std::vector<Hit> meet(const Ray& ray, const Sphere& sphere);

}  // namespace oracle
