#include <algorithm>
#include <limits>
#include <vector>

#include "bake/sphere.h"
#include "reference/media.h"
#include "reference/world.h"
#include "render/renderer.h"
#include "render/steps.h"

namespace whit {

namespace {

Box boundsWithin(const Scene& scene, const Geometry& geometry) {
  Box box;
  for (std::size_t i = 0; i < geometry.index.size(); ++i) {
    const TriangleRecord& triangle = scene.triangles[geometry.firstTriangle + i];
    if (scene.mediumOfMaterial[triangle.material] == 0) continue;
    for (int k = 0; k < 9; k += 3) {
      box.add({triangle.position[k], triangle.position[k + 1], triangle.position[k + 2]});
    }
  }
  for (std::uint32_t i = 0; i < geometry.spheres; ++i) {
    const TriangleRecord& sphere = scene.triangles[geometry.firstSphere + i];
    if (scene.mediumOfMaterial[sphere.material] == 0) continue;
    const Box own = sphereBounds(sphereMap(sphere));
    box.add(own.lower);
    box.add(own.upper);
  }
  return box;
}

}  // namespace

Box dielectricBounds(const Scene& scene) {
  std::vector<Box> boxes;
  for (const Geometry& geometry : scene.geometries) boxes.push_back(boundsWithin(scene, geometry));
  Box all = boxes.empty() ? Box() : boxes[0];
  for (const InstanceRecord& instance : scene.instances) {
    const Box& own = boxes[instance.geometry];
    for (int i = 0; i < 8 && !own.empty(); ++i) {
      all.add(Vec3f(instance.toWorld.point(Vec3d(own.corner(i)))));
    }
  }
  return all;
}

bool startsMeet(const CameraFrame& camera, const Box& dielectrics) {
  if (dielectrics.empty()) return false;
  const Vec3d lower = Vec3d(dielectrics.lower), upper = Vec3d(dielectrics.upper);
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  for (int i = 0; i < 8; ++i) {
    const double ahead = dot(Vec3d(dielectrics.corner(i)) - camera.eye, camera.forward);
    nearest = std::min(nearest, ahead);
    farthest = std::max(farthest, ahead);
  }
  if (nearest > 0 || farthest < 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (camera.eye[axis] + camera.reach[axis] < lower[axis]) return false;
    if (camera.eye[axis] - camera.reach[axis] > upper[axis]) return false;
  }
  return true;
}

void findInitialMedia(Chunk& c) {
  if (!c.frame->camera.mediaVary) return;
  const EmbreeIntersector intersector(*c.frame->accel);
  for (std::size_t i = 0; i < c.n; ++i) {
    c.rays.media[i] = reference::mediaAtStart(*c.frame->scene, c.frame->effects, intersector,
                                              c.frame->camera, reference::rayOf(c, i));
  }
}

}  // namespace whit
