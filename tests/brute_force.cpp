#include "brute_force.h"

#include <limits>

#include "bake/sphere.h"
#include "surfaces/intersect.h"
#include "surfaces/passed_surfaces.h"

namespace whit {

namespace {

// Calls visit(candidate) for the triangles and spheres of one geometry.
template <typename Visitor>
void forEachSurface(const Geometry& geometry, std::uint32_t instance, bool spheres,
                    Visitor&& visit) {
  for (std::uint32_t i = 0; i < geometry.classBegin[kTriangleClasses]; ++i) {
    visit(Candidate{geometry.firstTriangle + i, instance});
  }
  for (std::uint32_t i = 0; spheres && i < geometry.spheres; ++i) {
    visit(Candidate{geometry.firstSphere + i, instance});
  }
}

// Visits the surfaces of the world first, then those of each instance.
template <typename Visitor>
void forEachSurface(const Scene& scene, EffectSet effects, Visitor&& visit) {
  const bool spheres = effects.has(Effect::spheres);
  if (!scene.geometries.empty()) forEachSurface(scene.geometries[0], kNoHit, spheres, visit);
  if (!effects.has(Effect::instances)) return;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    forEachSurface(scene.geometries[scene.instances[i].geometry], i, spheres, visit);
  }
}

// Calls visit(hit) for the points where the ray hits the candidate, the nearest first.
template <typename Visitor>
void forEachHit(const Scene& scene, const Ray& ray, const Candidate& of, Visitor&& visit) {
  if (scene.isSphere(of.triangle)) {
    const Affine map = sphereInWorld(scene, {of.triangle, of.instance});
    for (const TriangleHit& hit : intersectSphere(ray, map)) visit(hit);
    return;
  }
  const auto hit = intersectTriangle(ray, worldCorners(scene, of.triangle, of.instance));
  if (hit) visit(*hit);
}

}  // namespace

bool BruteForce::closest(const Ray& ray, Candidate& candidate) const {
  double nearest = std::numeric_limits<double>::infinity();
  forEachSurface(scene_, effects_, [&](const Candidate& of) {
    forEachHit(scene_, ray, of, [&](const TriangleHit& hit) {
      if (!(hit.t < nearest && hit.t > ray.tNear)) return;
      if (effects_.has(Effect::alphaMasks) && cutAway(scene_, of.triangle, hit)) return;
      if (isPassed(scene_, of.triangle, of.instance, ray.direction)) return;
      nearest = hit.t;
      candidate = {of.triangle, of.instance, hit.u, hit.v};
    });
  });

  return nearest < std::numeric_limits<double>::infinity();
}

bool BruteForce::occluded(const Ray& ray, double tFar) const {
  bool found = false;
  forEachSurface(scene_, effects_, [&](const Candidate& of) {
    if (found || !scene_.materials[scene_.triangles[of.triangle].material].castsShadow) return;
    forEachHit(scene_, ray, of, [&](const TriangleHit& hit) {
      if (found || !(hit.t < tFar)) return;
      found = !effects_.has(Effect::alphaMasks) || !cutAway(scene_, of.triangle, hit, true);
    });
  });
  return found;
}

}  // namespace whit
