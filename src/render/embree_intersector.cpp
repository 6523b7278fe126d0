#include "render/embree_intersector.h"

namespace whit {

bool EmbreeIntersector::closest(const Ray& ray, Candidate& c) const {
  const Hit hit =
      accel_.closest(Vec3f(ray.origin), Vec3f(ray.direction), static_cast<float>(ray.tNear));
  c.triangle = hit.triangle;
  c.instance = hit.instance;
  c.u = double{hit.u};
  c.v = double{hit.v};
  return hit.found();
}

bool EmbreeIntersector::occluded(const Ray& ray, double tFar) const {
  return accel_.occluded(Vec3f(ray.origin), Vec3f(ray.direction), static_cast<float>(tFar));
}

}  // namespace whit
