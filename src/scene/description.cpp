#include "scene/description.h"

#include <algorithm>
#include <utility>

namespace whit {

void carry(const Camera& own, const Affine& map, Camera& camera) {
  constexpr double kNearest = 1.0 / 16;
  const Vec3d eye = map.point(Vec3d(own.eye));
  // Where the map flattens the view direction, the camera keeps its own.
  Vec3d forward = map.vector(Vec3d(own.at) - Vec3d(own.eye));
  if (forward == Vec3d()) forward = Vec3d(own.at) - Vec3d(own.eye);

  // A target too close to the eye would lose the direction when both are rounded to float.
  const double distance = std::max(length(forward), kNearest * length(eye));
  camera.eye = Vec3f(eye);
  camera.at = Vec3f(eye + normalized(forward) * distance);
  camera.up = Vec3f(normalized(map.vector(Vec3d(own.up)), Vec3d(own.up)));

  // `at` may have moved away from the plane of focus.
  if (own.hasLens() && own.focus == 0) camera.focus = static_cast<float>(length(forward));
}

void carry(const MovingLight& own, const Affine& map, Light& light) {
  light.position = Vec3f(map.point(Vec3d(own.position)));
  light.direction = Vec3f(normalized(map.vector(Vec3d(own.direction)), Vec3d(own.direction)));
}

void transform(Mesh& mesh, const Affine& map) {
  if (map == Affine{}) {
    for (Vec3f& n : mesh.normals) n = Vec3f(normalized(Vec3d(n)));
    return;
  }

  mesh.fromModel = map * mesh.fromModel;
  for (Affine& sphere : mesh.spheres) sphere = map * sphere;
  for (Vec3f& p : mesh.positions) p = Vec3f(map.point(Vec3d(p)));
  for (Vec3f& n : mesh.normals) n = Vec3f(normalized(map.normal(Vec3d(n))));

  // A map that mirrors turns the winding around, which has to remain counter-clockwise.
  if (map.determinant() < 0) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  }
}

}  // namespace whit
