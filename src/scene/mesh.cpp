#include "scene/mesh.h"

#include <utility>

namespace whit {

namespace {

// Squares of floats neither overflow nor vanish in double; only a very steep `map` needs the slower
// way that scales first.
Vec3f unitOrZero(const Vec3d& n) {
  const double square = dot(n, n);
  if (square > 1e-200 && square < 1e200) return Vec3f(n / std::sqrt(square));
  return Vec3f(normalized(n));
}

}  // namespace

void transform(Mesh& mesh, const Affine& map) {
  if (map == Affine{}) {
    for (Vec3f& n : mesh.normals) n = unitOrZero(Vec3d(n));
    return;
  }
  mesh.fromModel = map * mesh.fromModel;
  for (Affine& sphere : mesh.spheres) sphere = map * sphere;
  for (Vec3f& p : mesh.positions) p = Vec3f(map.point(Vec3d(p)));
  for (Vec3f& n : mesh.normals) n = unitOrZero(map.normal(Vec3d(n)));
  if (map.determinant() < 0) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  }
}

}  // namespace whit
