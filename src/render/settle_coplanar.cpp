#include "render/steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "bake/facet.h"
#include "bake/sphere.h"

namespace whit {

namespace {

using Face = CoplanarFace;

// Intersects as Woop, Benthin and Wald 2013, "Watertight ray/triangle intersection", in double. A
// hit on the border counts. Returns false for a miss.
bool intersect(const Line& ray, const Corners& corners, LineHit& hit) {
  const Vec3d size = abs(ray.direction);
  const int z = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int x = (z + 1) % 3, y = (z + 2) % 3;
  const double speed = ray.direction[z], slopeX = ray.direction[x] / speed,
               slopeY = ray.direction[y] / speed;
  std::array<Vec3d, 3> p;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d from = corners[i] - ray.origin;
    p[i] = {from[x] - slopeX * from[z], from[y] - slopeY * from[z], from[z] / speed};
  }
  const auto side = [](const Vec3d& a, const Vec3d& b) { return a.x * b.y - a.y * b.x; };
  const double w0 = side(p[1], p[2]), w1 = side(p[2], p[0]), w2 = side(p[0], p[1]);
  if (std::min({w0, w1, w2}) < 0 && std::max({w0, w1, w2}) > 0) return false;
  const double sum = w0 + w1 + w2;
  hit = {(w0 * p[0].z + w1 * p[1].z + w2 * p[2].z) / sum, w1 / sum, w2 / sum};
  return std::isfinite(hit.t) && std::isfinite(hit.u) && std::isfinite(hit.v) && hit.t > 0;
}

// The corners that two triangles share, if the hit on `a` lies between them; 0 if it does not.
int sharedCorners(const Corners& a, const LineHit& hit, const Corners& b) {
  constexpr double kRounding = 1e-9;
  const std::array<double, 3> weights{1 - hit.u - hit.v, hit.u, hit.v};
  int shared = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::ranges::find(b, a[i]) != b.end()) {
      ++shared;
    } else if (weights[i] > kRounding) {
      return 0;
    }
  }
  return shared;
}

class FacesOfRay {
 public:
  FacesOfRay(const TracedScene& traced, const Line& ray) : traced_(traced), ray_(ray) {}

  std::vector<Face> at(PlacedTriangleId found, double u, double v) {
    const CoplanarTriangles& coplanar = traced_.scene.coplanar;
    coplanar.forEachPartnerAt(
        found, u, v, [&](PlacedTriangleId id, std::uint32_t rank) { add(id, rank, false); });
    if (faces_.empty()) return {};
    add(found, coplanar.rankOf(found), true);
    dropFarther();
    std::ranges::sort(faces_, [](const Face& a, const Face& b) { return a.rank < b.rank; });
    dropNeighbors();
    return std::move(faces_);
  }

 private:
  // `isFound`: Embree has reported this triangle, so it counts from either side, although rounding
  // may have it that an edge-on triangle is seen from behind.
  void add(PlacedTriangleId id, std::uint32_t rank, bool isFound) {
    const auto& [scene, accel, effects] = traced_;
    const bool instanced = id.instance != kNoInstance;
    if (instanced && !effects.has(Effect::instances)) return;
    Face face{id, {}, 0, 0, rank, 0, true, false};
    const Corners corners = worldCorners(scene, id.triangle, id.instance);
    if (!intersect(ray_, corners, face.hit)) return;
    if (accel.isCutAway(id.triangle, face.hit.u, face.hit.v)) return;
    const auto& [a, b, c] = worldCorners(scene, id.triangle, kNoInstance);
    Vec3d outward = cross(b - a, c - a);
    if (instanced) outward = scene.instances[id.instance].toWorld.normal(outward);
    const double facing = dot(ray_.direction, outward);
    const std::uint32_t number = scene.triangles[id.triangle].material;
    const Material& material = scene.materials[number];
    if (!isFound && !material.doubleSided && facing > 0) return;
    face.entering = facing < 0;
    if (effects.has(Effect::transmission)) {
      face.medium = scene.mediumOfMaterial[number];
      face.opaque = !material.passesLight();
    }
    const double error = distanceError(corners);
    face.nearest = face.hit.t - error;
    face.farthest = face.hit.t + error;
    faces_.push_back(face);
  }

  // The distance of a hit is off by the rounding of the corners along the normal, as seen from the
  // ray's start.
  double distanceError(const Corners& corners) const {
    Vec3d far;
    for (const Vec3d& corner : corners) far = max(far, abs(corner - ray_.origin));
    const Vec3d n = normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
    return kErrorOfMagnitude * dot(abs(n), far) / std::abs(dot(n, ray_.direction));
  }

  // Keeps the nearest face and the ones that floats cannot tell from it.
  void dropFarther() {
    const auto nearest =
        std::ranges::min_element(faces_, {}, [](const Face& f) { return f.hit.t; });
    std::erase_if(faces_,
                  [most = nearest->farthest](const Face& face) { return face.nearest > most; });
  }

  // Two triangles of one surface that share the edge or corner that is hit are one face.
  bool areNeighbors(const Face& a, const Face& b) const {
    if (a.medium != b.medium || a.entering != b.entering || a.id.instance != b.id.instance) {
      return false;
    }
    const Corners own = worldCorners(traced_.scene, a.id.triangle, kNoInstance),
                  other = worldCorners(traced_.scene, b.id.triangle, kNoInstance);
    const int shared = sharedCorners(own, a.hit, other);
    return (shared == 1 || shared == 2) && sharedCorners(other, b.hit, own) == shared;
  }
  void dropNeighbors() {
    std::vector<Face> kept;
    for (const Face& face : faces_) {
      const auto isNeighbor = [&](const Face& other) { return areNeighbors(other, face); };
      if (std::ranges::none_of(kept, isNeighbor)) kept.push_back(face);
    }
    faces_ = std::move(kept);
  }

  const TracedScene& traced_;
  const Line& ray_;
  std::vector<Face> faces_;
};

const Face& chosenOf(const std::vector<Face>& faces, const std::vector<Medium>& media) {
  const auto preference = [&](const Face& face) {
    return std::tuple(face.opaque, face.medium == 0, media[face.medium].priority, face.rank);
  };
  return *std::ranges::max_element(faces, {}, preference);
}

// HitColumns::alsoCrossed.
std::uint32_t crossedWith(const Face& chosen, const std::vector<Face>& faces) {
  std::uint32_t others = 0;
  for (const Face& face : faces) {
    if (&face == &chosen || chosen.opaque || face.medium == 0 || others >> 20 != 0) continue;
    others = others << 10 | face.medium << 1 | (face.entering ? 1 : 0);
  }
  return faces.size() > 1 ? others | kSharesPlace : others;
}

}  // namespace

std::vector<CoplanarFace> coplanarFaces(const TracedScene& traced, const Line& ray,
                                        PlacedTriangleId found, double u, double v) {
  const CoplanarTriangles& coplanar = traced.scene.coplanar;
  if (!coplanar.any(found.triangle) || !coplanar.anyAt(found, u, v)) return {};
  return FacesOfRay(traced, ray).at(found, u, v);
}

void settleCoplanar(Chunk& c) {
  const TracedScene traced{*c.frame->scene, *c.frame->accel, c.frame->effects};
  std::fill_n(c.hits.alsoCrossed, c.n, 0u);
  const bool instanced = c.has(Feature::instances);
  for (std::size_t i = 0; i < c.n; ++i) {
    if (!traced.scene.coplanar.any(c.hits.triangle[i])) continue;
    const PlacedTriangleId found{c.hits.triangle[i], instanced ? c.hits.instance[i] : kNoInstance};
    const Line ray{Vec3d{c.rays.orgX[i], c.rays.orgY[i], c.rays.orgZ[i]},
                   Vec3d{c.rays.dirX[i], c.rays.dirY[i], c.rays.dirZ[i]}};
    const std::vector<Face> faces =
        coplanarFaces(traced, ray, found, double{c.hits.u[i]}, double{c.hits.v[i]});
    if (faces.empty()) continue;
    const Face& chosen = chosenOf(faces, traced.scene.media);
    c.hits.triangle[i] = chosen.id.triangle;
    if (instanced) c.hits.instance[i] = chosen.id.instance;
    c.hits.t[i] = static_cast<float>(chosen.hit.t);
    c.hits.u[i] = static_cast<float>(chosen.hit.u);
    c.hits.v[i] = static_cast<float>(chosen.hit.v);
    c.hits.alsoCrossed[i] = crossedWith(chosen, faces);
  }
}

SphereHit chosenSphere(const TracedScene& traced, const SphereHit& found) {
  const auto& [scene, accel, effects] = traced;
  const auto place = scene.coincidentSpheres.find(orderOf(found.id));
  if (place == scene.coincidentSpheres.end()) return found;
  const Vec3d point = sphereInWorld(scene, found.id).point(spherePoint(found.u, found.v));
  SphereHit chosen = found;
  std::tuple<bool, bool, int> most(false, false, std::numeric_limits<int>::min());
  for (const PlacedTriangleId& id : *place->second) {
    if (id.instance != kNoInstance && !effects.has(Effect::instances)) continue;
    const auto [u, v] = sphereWeights(onUnitSphere(sphereInWorld(scene, id), point));
    if (id != found.id && accel.isCutAway(id.triangle, u, v)) continue;
    const std::uint32_t material = scene.triangles[id.triangle].material;
    const std::uint8_t medium = scene.mediumOfMaterial[material];
    const std::tuple own(!scene.materials[material].passesLight(), medium == 0,
                         scene.media[medium].priority);
    if (own >= most) most = own, chosen = id == found.id ? found : SphereHit{id, u, v};
  }
  return chosen;
}

void settleSpheres(Chunk& c) {
  const TracedScene traced{*c.frame->scene, *c.frame->accel, c.frame->effects};
  const bool instanced = c.has(Feature::instances);
  for (std::size_t i = 0; i < c.n; ++i) {
    const PlacedTriangleId id{c.hits.triangle[i], instanced ? c.hits.instance[i] : kNoInstance};
    const SphereHit chosen = chosenSphere(traced, {id, double{c.hits.u[i]}, double{c.hits.v[i]}});
    c.hits.triangle[i] = chosen.id.triangle;
    if (instanced) c.hits.instance[i] = chosen.id.instance;
    c.hits.u[i] = static_cast<float>(chosen.u);
    c.hits.v[i] = static_cast<float>(chosen.v);
  }
}

}  // namespace whit
