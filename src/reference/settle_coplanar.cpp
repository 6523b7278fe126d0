#include "reference/settle_coplanar.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "reference/find_intersections.h"
#include "reference/intersect.h"
#include "reference/media.h"

namespace whit::reference {

namespace {

PlacedTriangleId idOf(const Candidate& c) { return {c.triangle, c.instance}; }

bool isEntered(const Scene& scene, const Candidate& c, const Vec3d& direction) {
  const Corners corners = worldCorners(scene, c.triangle, kNoInstance);
  Vec3d normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  if (c.instance != kNoInstance) normal = scene.instances[c.instance].toWorld.normal(normal);
  return dot(direction, normal) < 0;
}

// Returns how many corners of `a` are corners of `b` as well; 0 where the hit does not lie between
// these.
int cornersBetween(const Corners& a, const Corners& b, const TriangleHit& hit) {
  constexpr double kRounding = 1e-9;
  const double weights[] = {1 - hit.u - hit.v, hit.u, hit.v};
  int shared = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const bool isShared = std::ranges::find(b, a[i]) != b.end();
    if (!isShared && weights[i] > kRounding) return 0;
    shared += isShared;
  }
  return shared;
}

// True if two triangles are neighbors in one surface, which a ray passes once through the edge or
// corner that they share. With all corners in common they lie on each other instead.
bool areNeighbors(const Scene& scene, const Place& a, const Place& b) {
  if (a.medium != b.medium || a.entering != b.entering) return false;
  if (a.candidate.instance != b.candidate.instance) return false;

  const Corners corners = worldCorners(scene, a.candidate.triangle, kNoInstance);
  const Corners others = worldCorners(scene, b.candidate.triangle, kNoInstance);
  const int shared = cornersBetween(corners, others, a.hit);
  return shared > 0 && shared < 3 && cornersBetween(others, corners, b.hit) == shared;
}

// Keeps the first of neighboring triangles.
void mergeNeighbors(const Scene& scene, std::vector<Place>& places) {
  std::ranges::sort(places, [](const Place& a, const Place& b) { return a.rank < b.rank; });
  std::vector<Place> surfaces;
  for (const Place& place : places) {
    const bool known = std::ranges::any_of(
        surfaces, [&](const Place& other) { return areNeighbors(scene, other, place); });
    if (!known) surfaces.push_back(place);
  }

  places = std::move(surfaces);
}

// Returns a bound on the rounding error of a hit's distance in floats. Only the components along
// the normal of the corners, relative to the ray's start, count.
double distanceError(const Scene& scene, const Ray& ray, const Place& place) {
  const Corners corners = worldCorners(scene, place.candidate.triangle, place.candidate.instance);
  Vec3d far;
  for (const Vec3d& corner : corners) far = max(far, abs(corner - ray.origin));
  const Vec3d n = normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
  const double error = 32 * kUnitRoundOff * dot(abs(n), far);
  return error / std::abs(dot(n, ray.direction));
}

// Keeps the places that are no farther than the nearest one, as far as floats can tell.
void keepNearest(const Scene& scene, const Ray& ray, std::vector<Place>& places) {
  if (places.empty()) return;

  const auto nearest = std::ranges::min_element(places, {}, [](const Place& p) { return p.hit.t; });
  const double least = nearest->hit.t + distanceError(scene, ray, *nearest);
  std::erase_if(places, [&](const Place& place) {
    return place.hit.t - distanceError(scene, ray, place) > least;
  });
}

// True if light hits `a` rather than `b`: an opaque surface first, and a sheet before a dielectric.
bool comesFirst(const Scene& scene, const Place& a, const Place& b) {
  if (a.opaque != b.opaque) return a.opaque;
  if ((a.medium == 0) != (b.medium == 0)) return a.medium == 0;

  const int priorityA = scene.media[a.medium].priority, priorityB = scene.media[b.medium].priority;
  if (priorityA != priorityB) return priorityA > priorityB;
  return a.rank > b.rank;
}

}  // namespace

std::vector<Place> placesAt(const Scene& scene, EffectSet effects, const Ray& ray,
                            const Candidate& met) {
  std::vector<Place> places;
  if (!scene.coplanar.any(met.triangle)) return places;

  // A surface counts unless the ray misses it, passes through a hole of its mask or hits its back
  // where it is single-sided.
  const auto add = [&](const PlacedTriangleId& id, std::uint32_t rank) {
    if (id.instance != kNoInstance && !effects.has(Effect::instances)) return;
    const auto hit = intersectTriangle(ray, worldCorners(scene, id.triangle, id.instance));
    if (!hit) return;
    if (effects.has(Effect::alphaMasks) && cutAway(scene, id.triangle, *hit)) return;

    // The triangle that was hit is there, although rounding may deny it for edge-on triangles.
    const bool isMet = id == idOf(met);
    if (!isMet && isPassed(scene, id.triangle, id.instance, ray.direction)) return;

    Place place{{id.triangle, id.instance, hit->u, hit->v}, *hit, 0, false, true, rank};
    if (effects.has(Effect::transmission)) {
      const std::uint32_t material = scene.triangles[id.triangle].material;
      place.medium = scene.mediumOfMaterial[material];
      place.opaque = !scene.materials[material].passesLight();
    }
    place.entering = isEntered(scene, place.candidate, ray.direction);
    places.push_back(place);
  };

  // The partners that overlap the triangle at this point are added first, then the triangle itself.
  scene.coplanar.forEachPartnerAt(idOf(met), met.u, met.v, add);
  if (places.empty()) return places;
  add(idOf(met), scene.coplanar.rankOf(idOf(met)));

  // Surfaces farther away than float rounding explains are dropped, and neighbors count as one.
  keepNearest(scene, ray, places);
  mergeNeighbors(scene, places);
  return places;
}

Settled settleCoplanar(const Scene& scene, EffectSet effects, const Ray& ray,
                       const Candidate& met) {
  if (scene.isSphere(met.triangle)) return {settleSpheres(scene, effects, met), {}};
  if (scene.coplanar.empty()) return {met, {}};

  const std::vector<Place> places = placesAt(scene, effects, ray, met);
  if (places.empty()) return {met, {}};

  const Place* first = &places[0];
  for (const Place& place : places) {
    if (comesFirst(scene, place, *first)) first = &place;
  }

  // Light that crosses a dielectric crosses all others in the same place as well.
  Settled settled{first->candidate, first->hit};
  for (const Place& place : places) {
    if (&place == first || first->opaque || place.medium == 0) continue;
    settled.alsoCrossed = withCrossing(settled.alsoCrossed, place.medium, place.entering);
  }

  if (places.size() > 1) settled.alsoCrossed |= kSharesPlace;
  return settled;
}

Candidate settleSpheres(const Scene& scene, EffectSet effects, const Candidate& met) {
  const auto place = scene.coincidentSpheres.find(orderOf(idOf(met)));
  if (place == scene.coincidentSpheres.end()) return met;

  const PlacedTriangleId sphere = idOf(met);
  const Vec3d point = sphereInWorld(scene, sphere).point(spherePoint(met.u, met.v));

  std::optional<Place> best;
  std::uint32_t rank = 0;
  for (const PlacedTriangleId& id : *place->second) {
    if (id.instance != kNoInstance && !effects.has(Effect::instances)) continue;

    // Coincident spheres may be rotated, so the point has other weights on each of them.
    const auto [u, v] = sphereWeights(onUnitSphere(sphereInWorld(scene, id), point));
    const TriangleHit hit{0, u, v};
    if (id != sphere && effects.has(Effect::alphaMasks) && cutAway(scene, id.triangle, hit)) {
      continue;
    }

    const std::uint32_t material = scene.triangles[id.triangle].material;
    const Place own{{id.triangle, id.instance, u, v},         hit,
                    scene.mediumOfMaterial[material],         false,
                    !scene.materials[material].passesLight(), rank++};

    if (!best || comesFirst(scene, own, *best)) best = own;
  }

  return best ? best->candidate : met;
}

}  // namespace whit::reference
