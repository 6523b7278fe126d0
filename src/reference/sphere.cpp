#include "reference/sphere.h"

#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "bake/sphere.h"
#include "reference/find_intersections.h"

namespace whit::reference {

std::vector<TriangleHit> intersectSphere(const Ray& ray, const Affine& fromUnit) {
  std::vector<TriangleHit> hits;
  const auto roots = meetSphere(fromUnit, ray.origin, ray.direction);
  if (!roots) return hits;
  for (const double t : {roots->near, roots->far}) {
    if (!(t > 0)) continue;
    const auto [u, v] = sphereWeights(onUnitSphere(fromUnit, ray.origin + ray.direction * t));
    hits.push_back({t, u, v});
  }
  return hits;
}

TriangleHit refineSphereHit(const Scene& scene, const Ray& ray, const Candidate& candidate) {
  const Affine map = sphereInWorld(scene, {candidate.triangle, candidate.instance});
  const Vec3d there = map.point(spherePoint(candidate.u, candidate.v));
  const double squared = dot(ray.direction, ray.direction);
  const double hint = dot(there - ray.origin, ray.direction) / squared;
  TriangleHit best{hint > 0 ? hint : std::numeric_limits<double>::min(), candidate.u, candidate.v};
  double least = std::numeric_limits<double>::infinity();
  for (const TriangleHit& hit : intersectSphere(ray, map)) {
    const double off = std::fabs(hit.t - hint);
    if (!(off < least)) continue;
    least = off;
    best = hit;
  }
  return best;
}

Candidate settleSpheres(const Scene& scene, EffectSet effects, const Ray& ray,
                        const Candidate& met) {
  const auto place = scene.coincidentSpheres.find(orderOf({met.triangle, met.instance}));
  if (place == scene.coincidentSpheres.end()) return met;
  const auto preference = [&](const Candidate& c) {
    const std::uint32_t number = scene.triangles[c.triangle].material;
    const std::uint32_t medium = scene.mediumOfMaterial[number];
    return std::tuple(!scene.materials[number].passesLight(), medium == 0,
                      scene.media[medium].priority);
  };
  const Vec3d point = ray.origin + ray.direction * refineSphereHit(scene, ray, met).t;
  std::optional<Candidate> best;
  for (const PlacedTriangleId& id : *place->second) {
    if (id.instance != kNoInstance && !effects.has(Effect::instances)) continue;
    const auto [u, v] = sphereWeights(onUnitSphere(sphereInWorld(scene, id), point));
    const Candidate own{id.triangle, id.instance, u, v};
    const bool isMet = id.triangle == met.triangle && id.instance == met.instance;
    const TriangleHit hit{0, u, v};
    if (!isMet && effects.has(Effect::alphaMasks) && cutAway(scene, id.triangle, hit)) continue;
    if (!best || preference(own) >= preference(*best)) best = own;
  }
  return best.value_or(met);
}

}  // namespace whit::reference
