#include <limits>

#include "reference/find_intersections.h"
#include "reference/reference.h"
#include "reference/triangle.h"

namespace whit::reference {

namespace {

// Calls visit(triangle, instance) for the triangles of one geometry.
template <typename Visitor>
void forEachTriangle(const Geometry& geometry, std::uint32_t instance, Visitor&& visit) {
  for (std::uint32_t i = 0; i < geometry.classBegin[kTriangleClasses]; ++i) {
    visit(geometry.firstTriangle + i, instance);
  }
}

// The world's triangles first, then those of each instance.
template <typename Visitor>
void forEachTriangle(const Scene& scene, EffectSet effects, Visitor&& visit) {
  if (!scene.geometries.empty()) forEachTriangle(scene.geometries[0], kNoHit, visit);
  if (!effects.has(Effect::instances)) return;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    forEachTriangle(scene.geometries[scene.instances[i].geometry], i, visit);
  }
}

}  // namespace

bool BruteForce::closest(const Ray& ray, Candidate& candidate) const {
  double nearest = std::numeric_limits<double>::infinity();
  forEachTriangle(scene_, effects_, [&](std::uint32_t triangle, std::uint32_t instance) {
    const auto hit = intersectTriangle(ray, worldCorners(scene_, triangle, instance));
    if (!hit || !(hit->t < nearest && hit->t > ray.tNear)) return;
    if (effects_.has(Effect::alphaMasks) && cutAway(scene_, triangle, *hit)) return;
    if (isPassed(scene_, triangle, instance, ray.direction)) return;
    nearest = hit->t;
    candidate = {triangle, instance, hit->u, hit->v};
  });
  return nearest < std::numeric_limits<double>::infinity();
}

bool BruteForce::occluded(const Ray& ray, double tFar) const {
  bool found = false;
  forEachTriangle(scene_, effects_, [&](std::uint32_t triangle, std::uint32_t instance) {
    if (found || !scene_.materials[scene_.triangles[triangle].material].castsShadow) return;
    const auto hit = intersectTriangle(ray, worldCorners(scene_, triangle, instance));
    if (!hit || !(hit->t < tFar)) return;
    found = !effects_.has(Effect::alphaMasks) || !cutAway(scene_, triangle, *hit, true);
  });
  return found;
}

}  // namespace whit::reference
