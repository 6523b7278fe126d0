#include "surfaces/choose_surface.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/index.h"
#include "surfaces/passed_surfaces.h"

namespace whit {

namespace {

PlacedTriangleId idOf(const Candidate& c) { return {c.triangle, c.instance}; }

// Returns the number of corners that `a` and `b` share, or 0 if the hit on `a` does not lie on the
// corner or edge that they share.
int cornersBetween(const Corners& a, const Corners& b, const TriangleHit& hit) {
  constexpr double kRounding = 1e-9;
  const double weights[] = {1 - hit.u - hit.v, hit.u, hit.v};
  int shared = 0;
  for (const auto i : indices(3)) {
    const bool isShared = contains(b, a[i]);
    if (!isShared && weights[i] > kRounding) return 0;
    shared += isShared;
  }
  return shared;
}

// Returns true if two triangles are neighbors in one surface and both hits lie on the edge or
// corner that they share: the ray crosses that surface once. Triangles that share all three corners
// lie on each other and are not neighbors.
bool areNeighbors(const Scene& scene, const SurfaceHit& a, const SurfaceHit& b) {
  if (a.medium != b.medium || a.entering != b.entering) return false;
  if (a.candidate.instance != b.candidate.instance) return false;

  // Both belong to one instance, so we compare their corners as the object has them.
  const Corners corners = worldCorners(scene, a.candidate.triangle, kNoInstance);
  const Corners others = worldCorners(scene, b.candidate.triangle, kNoInstance);
  const int shared = cornersBetween(corners, others, a.hit);
  return shared > 0 && shared < 3 && cornersBetween(others, corners, b.hit) == shared;
}

// Sorts the hits by rank, and keeps the one of lowest rank among neighboring triangles.
void mergeNeighbors(const Scene& scene, std::vector<SurfaceHit>& hits) {
  std::ranges::sort(hits, [](const SurfaceHit& a, const SurfaceHit& b) { return a.rank < b.rank; });
  std::vector<SurfaceHit> merged;
  for (const SurfaceHit& surface : hits) {
    const bool known = std::ranges::any_of(
        merged, [&](const SurfaceHit& other) { return areNeighbors(scene, other, surface); });
    if (!known) merged.push_back(surface);
  }

  hits = std::move(merged);
}

// Returns a bound on the rounding error of a hit's distance in floats. Rounding the corners,
// relative to the ray's origin, moves the triangle's plane along its normal. Divided by the ray's
// component along the normal, this is the error along the ray.
double distanceError(const Scene& scene, const Ray& ray, const SurfaceHit& surface) {
  const Corners corners =
      worldCorners(scene, surface.candidate.triangle, surface.candidate.instance);
  Vec3d far;
  for (const Vec3d& corner : corners) far = max(far, abs(corner - ray.origin));
  const Vec3d n = normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
  const double error = 32 * kUnitRoundOff * dot(abs(n), far);
  return error / std::abs(dot(n, ray.direction));
}

// Keeps the hits that are no farther than the nearest one, as far as floats can tell.
void keepNearest(const Scene& scene, const Ray& ray, std::vector<SurfaceHit>& hits) {
  if (hits.empty()) return;

  const auto nearest =
      std::ranges::min_element(hits, {}, [](const SurfaceHit& p) { return p.hit.t; });
  const double least = nearest->hit.t + distanceError(scene, ray, *nearest);
  std::erase_if(hits, [&](const SurfaceHit& surface) {
    return surface.hit.t - distanceError(scene, ray, surface) > least;
  });
}

// Returns true if light hits `a` rather than `b`, by the order of chooseSurface().
bool comesFirst(const Scene& scene, const SurfaceHit& a, const SurfaceHit& b) {
  return preferenceOf(scene, a.opaque, a.medium, a.rank) >
         preferenceOf(scene, b.opaque, b.medium, b.rank);
}

// Adds a dielectric to those that light crosses together with the chosen one, packed as in
// HitColumns::alsoCrossed (stages/columns.h). Three fit; a fourth is left out.
std::uint32_t withCrossing(std::uint32_t others, std::uint32_t medium, bool entering) {
  constexpr int kMostOthers = 3;
  if (others >> (kCrossedBits * (kMostOthers - 1)) != 0) return others;
  return others << kCrossedBits | medium << 1 | (entering ? 1 : 0);
}

}  // namespace

std::vector<SurfaceHit> coplanarHits(const Scene& scene, EffectSet effects, const Ray& ray,
                                     const Candidate& found) {
  std::vector<SurfaceHit> hits;
  if (!scene.coplanar.any(found.triangle)) return hits;

  // A surface counts unless the ray misses it, passes through a hole of its mask or hits its back
  // where it is single-sided.
  const auto add = [&](const PlacedTriangleId& id, std::uint32_t rank) {
    if (id.instance != kNoInstance && !effects.has(Effect::instances)) return;
    const auto hit = intersectTriangle(ray, worldCorners(scene, id.triangle, id.instance));
    if (!hit) return;
    if (effects.has(Effect::alphaMasks) && cutAway(scene, id.triangle, *hit)) return;

    // The triangle of `found` always counts: if it is seen edge-on, rounding may take its front for
    // its back.
    const bool isFound = id == idOf(found);
    if (!isFound && isPassed(scene, id.triangle, id.instance, ray.direction)) return;

    SurfaceHit surface{
        .candidate = {id.triangle, id.instance, hit->u, hit->v}, .hit = *hit, .rank = rank};
    if (effects.has(Effect::transmission)) {
      const std::uint32_t material = scene.triangles[id.triangle].material;
      surface.medium = scene.mediumOfMaterial[material];
      surface.opaque = !scene.materials[material].passesLight();
    }
    surface.entering = dot(ray.direction, outwardNormal(scene, id.triangle, id.instance)) < 0;
    hits.push_back(surface);
  };

  // The partners that overlap the triangle at this point are added first, then the triangle itself.
  scene.coplanar.forEachPartnerAt(idOf(found), found.u, found.v, add);
  if (hits.empty()) return hits;
  add(idOf(found), scene.coplanar.rankOf(idOf(found)));

  // Surfaces farther away than float rounding explains are dropped, and neighbors count as one.
  keepNearest(scene, ray, hits);
  mergeNeighbors(scene, hits);
  return hits;
}

ChosenSurface chooseSurface(const Scene& scene, EffectSet effects, const Ray& ray,
                            const Candidate& found) {
  if (scene.isSphere(found.triangle)) return {chooseSphere(scene, effects, found), {}};
  if (scene.coplanar.empty()) return {found, {}};

  const std::vector<SurfaceHit> hits = coplanarHits(scene, effects, ray, found);
  if (hits.empty()) return {found, {}};

  const SurfaceHit* first = &hits[0];
  for (const SurfaceHit& surface : hits) {
    if (comesFirst(scene, surface, *first)) first = &surface;
  }

  // Light that crosses a dielectric crosses all others in the same place as well.
  ChosenSurface chosen{first->candidate, first->hit};
  for (const SurfaceHit& surface : hits) {
    if (&surface == first || first->opaque || surface.medium == 0) continue;
    chosen.alsoCrossed = withCrossing(chosen.alsoCrossed, surface.medium, surface.entering);
  }

  // With kSharesPlace, surfacePoint() gives new rays the larger offset that other surfaces here
  // need.
  if (hits.size() > 1) chosen.alsoCrossed |= kSharesPlace;
  return chosen;
}

Candidate chooseSphere(const Scene& scene, EffectSet effects, const Candidate& found) {
  const auto group = scene.coincidentSpheres.find(orderOf(idOf(found)));
  if (group == scene.coincidentSpheres.end()) return found;

  const PlacedTriangleId sphere = idOf(found);
  const Vec3d point = sphereInWorld(scene, sphere).point(spherePoint(found.u, found.v));

  std::optional<SurfaceHit> best;
  std::uint32_t rank = 0;
  for (const PlacedTriangleId& id : *group->second) {
    if (id.instance != kNoInstance && !effects.has(Effect::instances)) continue;

    // Coincident spheres may be rotated, so the point has different u and v on each of them.
    const auto [u, v] = sphereWeights(onUnitSphere(sphereInWorld(scene, id), point));
    const TriangleHit hit{0, u, v};
    if (id != sphere && effects.has(Effect::alphaMasks) && cutAway(scene, id.triangle, hit)) {
      continue;
    }

    const std::uint32_t material = scene.triangles[id.triangle].material;
    const SurfaceHit surface{.candidate = {id.triangle, id.instance, u, v},
                             .hit = hit,
                             .medium = scene.mediumOfMaterial[material],
                             .opaque = !scene.materials[material].passesLight(),
                             .rank = rank++};

    if (!best || comesFirst(scene, surface, *best)) best = surface;
  }

  return best ? best->candidate : found;
}

}  // namespace whit
